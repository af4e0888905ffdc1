#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/judge/judge.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::evaluation::judge {
namespace {

using test::FilledCheckpoint;
using test::MadeUpPairs;
using test::TinyManifest;

constexpr int kHidden = 3, kSlices = 6;

checkpoint::Checkpoint Model(const dataset::Dataset& dataset,
                             checkpoint::GeneratorVariant variant) {
  checkpoint::Manifest manifest = TinyManifest();
  manifest.model.skeleton = dataset.skeleton;
  manifest.model.classes = dataset.classes;
  manifest.parts = dataset.parts;
  test::PaperOf(manifest).variant = variant;
  test::PaperOf(manifest).encoder_hidden = kHidden;
  return FilledCheckpoint(manifest);
}

double Distance(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double{a[i]} - double{b[i]}, 2);
  return std::sqrt(sum);
}

metrics::FeatureSet Features(const checkpoint::Checkpoint& model, const dataset::Dataset& dataset,
                             const std::vector<int>& sequences, bool labelled = true) {
  absl::StatusOr<metrics::FeatureSet> features =
      LatentFeatures(model, dataset, sequences, labelled);
  EXPECT_THAT(features, IsOk());
  return features.ok() ? *std::move(features) : metrics::FeatureSet{};
}

TEST(LatentFeaturesTest, PointDoesNotDependOnTheBatch) {
  const dataset::Dataset dataset = MadeUpPairs(4);  // of 16 to 19 frames
  const checkpoint::Checkpoint model = Model(dataset, checkpoint::GeneratorVariant::kPaper);
  const metrics::FeatureSet together = Features(model, dataset, {0, 1, 2, 3});
  ASSERT_THAT(together, SizeIs(4));
  for (int i = 0; i < 4; ++i) {
    EXPECT_THAT(together[static_cast<size_t>(i)], SizeIs(kSlices * 2 * kHidden));
    const metrics::FeatureSet alone = Features(model, dataset, {i});
    EXPECT_LT(Distance(together[static_cast<size_t>(i)], alone[0]), 1e-5) << i;
  }
  EXPECT_GT(Distance(together[0], together[1]), 1e-3);
}

TEST(LatentFeaturesTest, LabelsMatterToTheModelsThatReadThem) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  const checkpoint::Checkpoint labelled = Model(dataset, checkpoint::GeneratorVariant::kPaper),
                               unlabelled =
                                   Model(dataset, checkpoint::GeneratorVariant::kUnlabelled);
  EXPECT_GT(
      Distance(Features(labelled, dataset, {0})[0], Features(labelled, dataset, {0}, false)[0]),
      1e-4);
  EXPECT_EQ(
      Distance(Features(unlabelled, dataset, {0})[0], Features(unlabelled, dataset, {0}, false)[0]),
      0);
}

TEST(LatentFeaturesTest, RefusesAModelOfOtherClasses) {
  dataset::Dataset dataset = MadeUpPairs(1);
  const checkpoint::Checkpoint model = Model(dataset, checkpoint::GeneratorVariant::kPaper);
  dataset.classes[1] = "duck";
  EXPECT_THAT(LatentFeatures(model, dataset, {0}, true),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("the data's classes")));
}

}  // namespace
}  // namespace duet::evaluation::judge
