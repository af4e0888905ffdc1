#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "model/checkpoint/manifest.h"
#include "tests/checkpoint/edited_manifest.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::CompleteManifest;
using test::TinyManifest;

using nlohmann::json;

Manifest FlowManifest() {
  Manifest manifest = CompleteManifest();
  FlowArchitecture flow;
  flow.width = 12;
  flow.blocks = 2;
  flow.heads = 3;
  flow.feed_forward = 20;
  flow.reach = 7;
  flow.offset_scale = 0.25;
  flow.noise = {3.5, 0.5, 6, 0.03};
  flow.steps = 4;
  flow.guidance = 1.25;
  flow.fade_frames = 2;
  manifest.architecture = flow;
  return manifest;
}

TEST(FlowManifest, RoundTrip) {
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(FlowManifest()));
  ASSERT_THAT(read, IsOk());
  ASSERT_TRUE(std::holds_alternative<FlowArchitecture>(read->architecture));
  const auto& flow = std::get<FlowArchitecture>(read->architecture);
  EXPECT_EQ(flow.width, 12);
  EXPECT_EQ(flow.blocks, 2);
  EXPECT_EQ(flow.heads, 3);
  EXPECT_EQ(flow.feed_forward, 20);
  EXPECT_EQ(flow.reach, 7);
  EXPECT_EQ(flow.offset_scale, 0.25);
  EXPECT_EQ(flow.noise.frame_length, 3.5);
  EXPECT_EQ(flow.noise.constant_share, 0.5);
  EXPECT_EQ(flow.noise.ramp_frames, 6);
  EXPECT_EQ(flow.noise.white, 0.03);
  EXPECT_EQ(flow.steps, 4);
  EXPECT_EQ(flow.guidance, 1.25);
  EXPECT_EQ(flow.fade_frames, 2);
  EXPECT_EQ(read->parts, FlowManifest().parts);
  EXPECT_TRUE(read->model.samples);
  EXPECT_TRUE(read->model.accepts_follower_start);
}

TEST(FlowManifest, HiddenFramesAreAnotherFeatureOfEveryFrame) {
  Manifest manifest = FlowManifest();
  auto& flow = std::get<FlowArchitecture>(manifest.architecture);
  const int64_t without = FrameFeatureCount(manifest, flow);
  EXPECT_FALSE(json::parse(SerializeManifest(manifest))["generator"].contains("hidden_frames"));
  flow.hidden_frames = true;
  EXPECT_EQ(FrameFeatureCount(manifest, flow), without + 1);
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_TRUE(std::get<FlowArchitecture>(read->architecture).hidden_frames);
}

TEST(FlowManifest, PaperGeneratorDoesNotSample) {
  Manifest manifest = TinyManifest();
  manifest.weights = FlowManifest().weights;
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_TRUE(std::holds_alternative<PaperArchitecture>(read->architecture));
  EXPECT_FALSE(read->model.samples);
}

// Version 1 had no kinds: all its generators are the paper's.
TEST(FlowManifest, VersionOneIsThePaperGenerator) {
  Manifest manifest = TinyManifest();
  manifest.weights = FlowManifest().weights;
  manifest.format_version = 1;
  const std::string text = SerializeManifest(manifest);
  EXPECT_FALSE(json::parse(text)["generator"].contains("kind"));
  const absl::StatusOr<Manifest> read = ParseManifest(text);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(SerializeManifest(*read), text);
}

TEST(FlowManifest, RejectsByName) {
  const auto refusal = [](const std::string& pointer, const json& value) {
    return ParseEdited(FlowManifest(), pointer, value);
  };
  EXPECT_THAT(refusal("/generator/kind", "wave"),
              IsInvalid("generator.kind: expected \"paper\" or \"flow\", got \"wave\""));
  EXPECT_THAT(refusal("/generator/kind", "paper"), IsInvalid("generator.variant"));
  EXPECT_THAT(refusal("/generator/heads", 5),
              IsInvalid("generator.heads: expected a divisor of the width 12, got 5"));
  EXPECT_THAT(refusal("/generator/width", 0), IsInvalid("generator.width: expected"));
  EXPECT_THAT(refusal("/generator/steps", 0), IsInvalid("generator.steps: expected"));
  EXPECT_THAT(refusal("/generator/offset_scale", 0), IsInvalid("generator.offset_scale"));
  EXPECT_THAT(refusal("/generator/noise/white", -1), IsInvalid("generator.noise.white"));
  EXPECT_THAT(refusal("/generator/noise/colour", 1),
              IsInvalid("generator.noise: unknown field \"colour\""));
  EXPECT_THAT(refusal("/generator/more", 1), IsInvalid("generator: unknown field \"more\""));
  EXPECT_THAT(refusal("/format_version", 1), IsInvalid("generator"));
}

TEST(FlowManifest, SizesDetermineTheTensors) {
  const Manifest manifest = FlowManifest();
  std::map<std::string, std::vector<int64_t>> shapes;
  for (const TensorSpec& spec : ExpectedTensors(manifest)) shapes[spec.name] = spec.shape;
  using Shape = std::vector<int64_t>;
  EXPECT_EQ(shapes.at("frames.weight"), (Shape{12, 9 * 3 + 5}));
  EXPECT_EQ(shapes.at("start.weight"), (Shape{12, 3 + 9 + 2}));
  EXPECT_EQ(shapes.at("label.weight"), (Shape{12, 2}));
  EXPECT_EQ(shapes.at("block1.attention.weight"), (Shape{36, 12}));
  EXPECT_EQ(shapes.at("block1.distance"), (Shape{3, 15}));
  EXPECT_EQ(shapes.at("block0.expand.weight"), (Shape{20, 12}));
  EXPECT_EQ(shapes.at("output.weight"), (Shape{9, 12}));
  EXPECT_EQ(shapes.at("base.poses"), (Shape{2, 9}));
  EXPECT_EQ(shapes.at("noise.roots"), (Shape{2, 9, 9}));
  EXPECT_EQ(shapes.count("block2.distance"), 0u);
}

TEST(FlowManifest, FrameLabelsAreAnInputOfEveryFrame) {
  Manifest manifest = FlowManifest();
  EXPECT_FALSE(json::parse(SerializeManifest(manifest))["generator"].contains("frame_labels"));
  auto& flow = std::get<FlowArchitecture>(manifest.architecture);
  flow.frame_labels = true;
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest)).status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("generator.guidance: expected 1 with frame_labels, got 1.25")));
  flow.guidance = 1;
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_TRUE(std::get<FlowArchitecture>(read->architecture).frame_labels);
  std::map<std::string, std::vector<int64_t>> shapes;
  for (const TensorSpec& spec : ExpectedTensors(*read)) shapes[spec.name] = spec.shape;
  EXPECT_EQ(shapes.at("frames.weight"), (std::vector<int64_t>{12, 9 * 3 + 5 + 2}));
  EXPECT_EQ(shapes.count("label.weight"), 0u);
}

}  // namespace
}  // namespace duet::checkpoint
