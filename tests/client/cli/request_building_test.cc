#include "client/cli/request_building.h"

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/motion/coordinates.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

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

TEST(BuildRequest, MetresPerUnitScalePositionsOfEveryUnit) {
  InputArguments input;
  input.metres_per_unit = 0.01;
  EXPECT_LT(Distance(ReadPoint(input), {0.01F, 0.02F, 0.03F}), 1e-6F);
  input.unit = motion::LengthUnit::kMillimetres;
  input.up_axis = motion::UpAxis::kZUp;
  EXPECT_LT(Distance(ReadPoint(input), {0.01F, 0.03F, -0.02F}), 1e-6F);
}

// The notes on a follower's start for a leader who stands: 0.9 m from foot to pelvis.
std::vector<std::string> NotesOnStart(const std::string& start) {
  const test::TemporaryFolder folder;
  SynthesizeArguments arguments;
  arguments.leader = folder / "leader.csv";
  arguments.input.frame_rate_hz = 30;
  arguments.level.automatic = false;
  arguments.follower_start = start;
  test::WriteTestFile(arguments.leader,
                      "frame,pelvis_x,pelvis_y,pelvis_z,left_foot_x,left_foot_y,left_foot_z,"
                      "right_foot_x,right_foot_y,right_foot_z\n0,0,1,0,0,0.1,0,0,0.1,0\n");
  motion::Skeleton skeleton;
  skeleton.joint_names = {"pelvis", "left_foot", "right_foot"};
  skeleton.bones = {{0, 1}, {0, 2}};
  skeleton.feet = motion::JointPair{1, 2};
  std::vector<std::string> notes;
  EXPECT_THAT(BuildRequest(arguments, skeleton, &notes), IsOk());
  return notes;
}

TEST(BuildRequest, AStartOnTheFloorOrInTheAirGetsAWarning) {
  EXPECT_THAT(NotesOnStart("0,0,1.2"),
              ElementsAre(HasSubstr("warning: --follower-start: expected Y near 1.00 m, where the "
                                    "pelvis of a standing person is, got 0")));
  EXPECT_THAT(NotesOnStart("0,5,1.2"), ElementsAre(HasSubstr("got 5")));
  EXPECT_THAT(NotesOnStart("0,0.5,1.2"), ElementsAre());
  EXPECT_THAT(NotesOnStart("0,1.1,1.2"), ElementsAre());
}

// The request of these keyframes and this beat for a leader of 10 s at a rate.
absl::StatusOr<SynthesisRequest> RequestToMusic(const motion::Beat& beat, double frame_rate_hz,
                                                std::vector<KeyframeArgument> keyframes) {
  const test::TemporaryFolder folder;
  SynthesizeArguments arguments;
  arguments.leader = folder / "leader.csv";
  arguments.input.frame_rate_hz = frame_rate_hz;
  arguments.beat = beat;
  arguments.keyframes = std::move(keyframes);
  std::string text = "frame,pelvis_x,pelvis_y,pelvis_z\n";
  for (int frame = 0; frame < 10 * frame_rate_hz; ++frame) {
    absl::StrAppend(&text, frame, ",1,2,3\n");
  }
  test::WriteTestFile(arguments.leader, text);
  motion::Skeleton skeleton;
  skeleton.joint_names = {"pelvis"};
  return BuildRequest(arguments, skeleton, nullptr);
}

KeyframeArgument AtBeat(double beats) { return {0, beats, {{"turn", 1}}}; }

std::vector<int> FramesOf(const absl::StatusOr<SynthesisRequest>& request) {
  EXPECT_THAT(request, IsOk());
  std::vector<int> frames;
  for (const WeightKeyframe& keyframe : request->keyframes) frames.push_back(keyframe.frame);
  return frames;
}

TEST(BuildRequest, BeatsBecomeTheNearestFramesAtTheLeadersRate) {
  // Beats 0, 1, 8 and 8.5 at 180 BPM from 0.1 s: 0.1, 0.433, 2.767 and 2.933 s.
  const std::vector<KeyframeArgument> beats = {AtBeat(0), AtBeat(1), AtBeat(8), AtBeat(8.5)};
  EXPECT_THAT(FramesOf(RequestToMusic({180, 0.1}, 24, beats)), ElementsAre(2, 10, 66, 70));
  EXPECT_THAT(FramesOf(RequestToMusic({180, 0.1}, 25, beats)), ElementsAre(3, 11, 69, 73));
  EXPECT_THAT(FramesOf(RequestToMusic({180, 0.1}, 30, beats)), ElementsAre(3, 13, 83, 88));
  EXPECT_THAT(FramesOf(RequestToMusic({180, 0.1}, 60, beats)), ElementsAre(6, 26, 166, 176));
}

TEST(BuildRequest, FramesAndBeatsMayBeMixed) {
  const auto request = RequestToMusic({120, 0}, 30, {{60, std::nullopt, {{"kick", 1}}}, AtBeat(8)});
  EXPECT_THAT(FramesOf(request), ElementsAre(60, 120));
  EXPECT_EQ(request->keyframes[0].weights[0].interaction_class, "kick");
  EXPECT_EQ(request->keyframes[1].weights[0].interaction_class, "turn");
}

TEST(BuildRequest, BeatsOutsideTheMotionAreRejected) {
  constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
  EXPECT_THAT(
      RequestToMusic({120, -0.25}, 30, {AtBeat(0)}),
      StatusIs(kInvalid, HasSubstr("--keyframe: expected a beat in the 10 s of the leader's "
                                   "motion, got 0b, at -0.25 s")));
  EXPECT_THAT(FramesOf(RequestToMusic({120, 0}, 30, {AtBeat(19.9)})), ElementsAre(299));
  EXPECT_THAT(RequestToMusic({120, 0}, 30, {AtBeat(20)}),
              StatusIs(kInvalid, HasSubstr("got 20b, at 10 s")));
  EXPECT_THAT(FramesOf(RequestToMusic({120, -0.25}, 30, {AtBeat(0.5)})), ElementsAre(0));
  EXPECT_THAT(RequestToMusic({120, 0}, 30, {AtBeat(1e12)}),
              StatusIs(kInvalid, HasSubstr("1e+12b")));
  EXPECT_THAT(RequestToMusic({120, 250}, 30, {AtBeat(0)}),
              StatusIs(kInvalid, HasSubstr("--beat: expected the first beat within the 10 s of the "
                                           "leader's motion, got 250 s")));
}

}  // namespace
}  // namespace duet::client::cli
