#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/checkpoint/manifest.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

Manifest SbuManifest() {
  Manifest manifest;
  manifest.model.skeleton = motion::SbuSkeleton();
  manifest.architecture = test::PublishedPaper();
  manifest.parts = motion::SbuParts();
  manifest.model.classes = {"kick", "push", "shake_hands", "hug", "exchange_object", "punch"};
  return manifest;
}

std::vector<int64_t> ShapeOf(const Manifest& manifest, const std::string& name) {
  for (const TensorSpec& spec : ExpectedTensors(manifest)) {
    if (spec.name == name) return spec.shape;
  }
  return {-1};
}

TEST(TensorTable, PaperSlicesOfSbu) {
  const std::vector<SliceShape> slices = SliceShapes(SbuManifest());
  ASSERT_EQ(slices.size(), 6u);
  EXPECT_EQ(slices[0].name, "left_arm");
  EXPECT_EQ(slices[0].input, 9);
  EXPECT_EQ(slices[0].features, 59);
  EXPECT_EQ(slices[5].name, "whole_body");
  EXPECT_EQ(slices[5].input, 45 + 6);
}

TEST(TensorTable, UnlabelledVariantReadsOnlyTheWholeBody) {
  Manifest manifest = SbuManifest();
  test::PaperOf(manifest).variant = GeneratorVariant::kUnlabelled;
  test::PaperOf(manifest).base_pose = true;
  EXPECT_EQ(SliceShapes(manifest)[5].input, 45);
  EXPECT_THAT(ShapeOf(manifest, "base.weight"), ElementsAre(-1));
  EXPECT_THAT(ShapeOf(manifest, "base.bias"), ElementsAre(45));
}

TEST(TensorTable, WholeBodySliceReadsTheFollowerStart) {
  Manifest manifest = SbuManifest();
  test::PaperOf(manifest).follower_start = true;
  EXPECT_EQ(StartFeatureCount(motion::SbuSkeleton()), 3 + 45 + 2);
  EXPECT_EQ(SliceShapes(manifest)[5].input, 45 + 6 + 50);
}

TEST(TensorTable, PaperSizesOfSbu) {
  const Manifest manifest = SbuManifest();
  EXPECT_EQ(ExpectedTensors(manifest).size(), 6u * 8 + 12 + 2);
  EXPECT_THAT(ShapeOf(manifest, "encoder.trunk.fc.weight"), ElementsAre(59, 9));
  EXPECT_THAT(ShapeOf(manifest, "encoder.trunk.fc.bias"), ElementsAre(59));
  EXPECT_THAT(ShapeOf(manifest, "encoder.whole_body.fc.weight"), ElementsAre(101, 51));
  EXPECT_THAT(ShapeOf(manifest, "encoder.trunk.backward.weight_ih"), ElementsAre(160, 59));
  EXPECT_THAT(ShapeOf(manifest, "encoder.trunk.forward.weight_hh"), ElementsAre(160, 40));
  EXPECT_THAT(ShapeOf(manifest, "encoder.trunk.forward.bias"), ElementsAre(160));
  EXPECT_THAT(ShapeOf(manifest, "decoder.forward.attention_encoded"), ElementsAre(128, 480));
  EXPECT_THAT(ShapeOf(manifest, "decoder.forward.attention_state"), ElementsAre(128, 240));
  EXPECT_THAT(ShapeOf(manifest, "decoder.backward.attention_score"), ElementsAre(128));
  EXPECT_THAT(ShapeOf(manifest, "decoder.backward.weight_ih"), ElementsAre(960, 480));
  EXPECT_THAT(ShapeOf(manifest, "decoder.backward.weight_hh"), ElementsAre(960, 240));
  EXPECT_THAT(ShapeOf(manifest, "decoder.backward.bias"), ElementsAre(960));
  EXPECT_THAT(ShapeOf(manifest, "output.weight"), ElementsAre(45, 480));
  EXPECT_THAT(ShapeOf(manifest, "output.bias"), ElementsAre(45));
}

TEST(TensorTable, BasePoseIsLinearInTheLabels) {
  Manifest manifest = SbuManifest();
  EXPECT_THAT(ShapeOf(manifest, "base.weight"), ElementsAre(-1));
  test::PaperOf(manifest).base_pose = true;
  EXPECT_THAT(ShapeOf(manifest, "base.weight"), ElementsAre(45, 6));
  EXPECT_THAT(ShapeOf(manifest, "base.bias"), ElementsAre(45));
}

}  // namespace
}  // namespace duet::checkpoint
