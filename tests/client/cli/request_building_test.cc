#include "client/cli/request_building.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/motion/coordinates.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

using test::IsOk;

// What BuildRequest makes of (1, 2, 3) in a file that does not say its coordinates.
motion::Vec3 ReadPoint(const InputArguments& input) {
  const test::TemporaryFolder folder;
  SynthesizeArguments arguments;
  arguments.leader = folder / "leader.csv";
  arguments.input = input;
  arguments.input.frame_rate_hz = 30;
  test::WriteTestFile(arguments.leader, "frame,pelvis_x,pelvis_y,pelvis_z\n0,1,2,3\n");
  motion::Skeleton skeleton;
  skeleton.joint_names = {"pelvis"};
  const auto request = BuildRequest(arguments, skeleton, nullptr);
  EXPECT_THAT(request, IsOk());
  return request.ok() ? request->leader.at(0, 0) : motion::Vec3{};
}

void ExpectPoint(const InputArguments& input, const motion::Coordinates& coordinates) {
  EXPECT_LT(Distance(ReadPoint(input), ToWorld(coordinates, {1, 2, 3})), 1e-5f);
}

TEST(BuildRequest, UnitOrAxisWithoutTheOtherUsesItsDefault) {
  using motion::LengthUnit;
  using motion::UpAxis;
  InputArguments input;
  input.up_axis = UpAxis::kZUp;
  ExpectPoint(input, {LengthUnit::kMetres, UpAxis::kZUp});
  input.unit = LengthUnit::kMillimetres;
  ExpectPoint(input, {LengthUnit::kMillimetres, UpAxis::kZUp});
  input.up_axis.reset();
  ExpectPoint(input, {LengthUnit::kMillimetres, UpAxis::kYUp});
  input.unit = LengthUnit::kSbuNormalised;
  ExpectPoint(input, {LengthUnit::kSbuNormalised, UpAxis::kYDown});
}

}  // namespace
}  // namespace duet::client::cli
