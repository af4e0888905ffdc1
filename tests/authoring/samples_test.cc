// The sample leaders that ship with the project: made from the key-frame texts beside them, and
// such as a person could move.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/authoring/keyframes.h"
#include "model/base/file.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_motion.h"
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
    bvh_ = SamplesFolder() / (std::string(GetParam()) + ".bvh");
    keyframes_ = SamplesFolder() / "keyframes" / (std::string(GetParam()) + ".txt");
    absl::StatusOr<motion::Clip> clip = formats::ReadLeader(bvh_);
    ASSERT_TRUE(clip.ok()) << clip.status();
    clip_ = *std::move(clip);
  }

  std::filesystem::path bvh_, keyframes_;
  motion::Clip clip_;
};

TEST_P(Sample, EqualsItsKeyFrames) {
  const absl::StatusOr<std::string> text = base::ReadFile(keyframes_, 1 << 20, "key frames"),
                                    committed = base::ReadFile(bvh_, 1 << 20, "a motion");
  ASSERT_TRUE(text.ok()) << text.status();
  ASSERT_TRUE(committed.ok()) << committed.status();
  const absl::StatusOr<motion::Clip> clip = ParseKeyframes(*text, keyframes_.string());
  ASSERT_TRUE(clip.ok()) << clip.status();
  const absl::StatusOr<formats::bvh::BvhDocument> made =
      formats::bvh::ToBvh(*clip, motion::SbuSkeleton());
  const absl::StatusOr<formats::bvh::BvhDocument> there =
      formats::bvh::ParseBvh(*committed, bvh_.string());
  ASSERT_TRUE(made.ok()) << made.status();
  ASSERT_TRUE(there.ok()) << there.status();
  const std::string advice = "run duet-keyframe " + keyframes_.string() + " --out " + bvh_.string();
  const auto hierarchy = [](const std::string& bvh) { return bvh.substr(0, bvh.find("MOTION")); };
  EXPECT_EQ(hierarchy(FormatBvh(*made)), hierarchy(*committed)) << advice;
  // The last digits may differ from one processor to another.
  EXPECT_THAT(made->values, ::testing::Pointwise(::testing::FloatNear(1e-3f), there->values))
      << advice;
}

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
