// tests/evaluation/judge/motion_classifier_test.cc compares the results with LibTorch's.
#include "model/classifier/classifier.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/classifier/random_classifier.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::classifier {
namespace {

using test::RandomClassifier;

motion::ClipPair Pair(int frames, double frame_rate_hz = 15) {
  motion::ClipPair pair;
  pair.leader.joint_names = motion::SbuSkeleton().joint_names;
  pair.leader.frame_rate_hz = frame_rate_hz;
  pair.leader.poses = test::SwayingMotion(frames, frame_rate_hz);
  pair.follower = pair.leader;
  for (motion::Vec3& position : pair.follower.poses.all()) position.x += 1;
  return pair;
}

motion::ClipPair Part(const motion::ClipPair& pair, int first, int frames) {
  motion::ClipPair part = pair;
  for (auto& [clip, from] :
       {std::pair<motion::Clip*, const motion::Clip*>{&part.leader, &pair.leader},
        {&part.follower, &pair.follower}}) {
    clip->poses = motion::Poses(0, from->joint_count());
    clip->poses.Append(from->poses.frames(first, frames));
  }
  return part;
}

TEST(Classifier, LongClipIsTheMeanOfItsWindowsAndTheLastEndsAtItsEnd) {
  const absl::StatusOr<Classifier> classifier = Classifier::Create(RandomClassifier());
  ASSERT_THAT(classifier, IsOk());
  const motion::ClipPair pair = Pair(50);
  std::vector<float> mean(2);
  for (const int first : {0, 20, 30}) {
    const std::vector<float> one = classifier->Probabilities(Part(pair, first, 20));
    ASSERT_THAT(one, SizeIs(2));
    EXPECT_NEAR(one[0] + one[1], 1, 1e-5);
    for (size_t c = 0; c < 2; ++c) mean[c] += one[c] / 3;
  }
  EXPECT_THAT(classifier->Probabilities(pair), Pointwise(FloatNear(1e-5f), mean));
}

TEST(Classifier, IgnoresThePlaceAndFacingOfThePair) {
  const absl::StatusOr<Classifier> classifier = Classifier::Create(RandomClassifier());
  ASSERT_THAT(classifier, IsOk());
  const motion::ClipPair pair = Pair(20);
  motion::ClipPair turned = pair;
  for (motion::Clip* clip : {&turned.leader, &turned.follower}) {
    for (motion::Vec3& p : clip->poses.all()) p = {p.z + 5, p.y, -p.x - 3};
  }
  EXPECT_THAT(classifier->Probabilities(turned),
              Pointwise(FloatNear(1e-4f), classifier->Probabilities(pair)));
}

TEST(Classifier, AcceptsOneFrame) {
  const absl::StatusOr<Classifier> classifier = Classifier::Create(RandomClassifier());
  ASSERT_THAT(classifier, IsOk());
  for (const double rate_hz : {15, 30}) {
    const std::vector<float> one = classifier->Probabilities(Pair(1, rate_hz));
    ASSERT_THAT(one, SizeIs(2));
    EXPECT_NEAR(one[0] + one[1], 1, 1e-5);
  }
}

TEST(Classifier, IgnoresTheFrameRateOfTheSameMotion) {
  const absl::StatusOr<Classifier> classifier = Classifier::Create(RandomClassifier());
  ASSERT_THAT(classifier, IsOk());
  EXPECT_THAT(classifier->Probabilities(Pair(39, 30)),
              Pointwise(FloatNear(1e-3f), classifier->Probabilities(Pair(20))));
}

TEST(Classifier, RejectsWrongPartsByName) {
  ClassifierParts parts = RandomClassifier();
  parts.tensors[0].shape[2] += 1;
  EXPECT_THAT(
      Classifier::Create(parts),
      StatusIs(absl::StatusCode::kInvalidArgument,
               HasSubstr("0.layer1_weight_ih: expected shape 2 x 16 x 135, got 2 x 16 x 136")));
  parts = RandomClassifier();
  parts.tensors.pop_back();
  EXPECT_THAT(Classifier::Create(parts),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("1.output.bias: expected shape 2, got none")));
  parts = RandomClassifier();
  parts.tensors.push_back({"more", {1}, {0}});
  EXPECT_THAT(Classifier::Create(parts),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected 16, got 17")));
  for (const float weight : {std::nanf(""), -2e6f}) {
    parts = RandomClassifier();
    parts.tensors[1].values[3] = weight;
    EXPECT_THAT(Classifier::Create(parts),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         HasSubstr(absl::StrCat("0.layer1_weight_hh: expected -1e6 to 1e6, got ",
                                                weight))));
  }
  parts = RandomClassifier();
  parts.classes = {"kick"};
  EXPECT_THAT(Classifier::Create(parts), StatusIs(absl::StatusCode::kInvalidArgument,
                                                  HasSubstr("classes: expected 2 or more, got 1")));
}

}  // namespace
}  // namespace duet::classifier
