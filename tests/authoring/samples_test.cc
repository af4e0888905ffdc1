// The sample leaders that ship with the project move as a person could.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "gtest/gtest.h"
#include "model/formats/motion_file.h"

namespace duet::authoring {
namespace {

constexpr int kLeftHip = 9, kRightHip = 12;

std::filesystem::path SamplesFolder() {
  const char* source = std::getenv("DUET_SOURCE_DIR");
  return std::filesystem::path(source != nullptr ? source : ".") / "samples";
}

class Sample : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    absl::StatusOr<motion::Clip> clip =
        formats::ReadLeader(SamplesFolder() / (std::string(GetParam()) + ".bvh"));
    ASSERT_TRUE(clip.ok()) << clip.status();
    clip_ = *std::move(clip);
  }

  motion::Clip clip_;
};

TEST_P(Sample, StandsOnTheFloorWithKneesThatBendForwards) {
  for (int frame = 0; frame < clip_.frame_count(); ++frame) {
    EXPECT_LT(std::min(clip_.at(frame, 11).y, clip_.at(frame, 14).y), 0.085f) << frame;
    const motion::Vec3 across = clip_.at(frame, kLeftHip) - clip_.at(frame, kRightHip);
    for (int hip : {kLeftHip, kRightHip}) {
      EXPECT_GT(std::min(clip_.at(frame, hip + 1).y, clip_.at(frame, hip + 2).y), 0.07f) << frame;
      const motion::Vec3 bend = Cross(clip_.at(frame, hip + 1) - clip_.at(frame, hip),
                                      clip_.at(frame, hip + 2) - clip_.at(frame, hip + 1));
      EXPECT_GT(Dot(bend, across), 0) << frame;
    }
  }
}

TEST_P(Sample, ActsTowardsAPartnerAhead) {
  // The end that acts comes at least 25 cm further forwards than it starts.
  float furthest = -1;
  for (int frame = 0; frame < clip_.frame_count(); ++frame) {
    for (int joint : {5, 8, 11, 14}) {
      furthest = std::max(furthest, clip_.at(frame, joint).z - clip_.at(0, joint).z);
    }
  }
  EXPECT_GT(furthest, 0.25f);
  EXPECT_LT(Distance(clip_.at(clip_.frame_count() - 1, 2), clip_.at(0, 2)), 0.05f)
      << "returns to where it began";
}

INSTANTIATE_TEST_SUITE_P(Classes, Sample,
                         ::testing::Values("kick", "push", "shake_hands", "hug", "exchange_object",
                                           "punch"));

}  // namespace
}  // namespace duet::authoring
