#include "client/batch/index.h"

#include <google/protobuf/util/json_util.h>

#include <string>
#include <vector>

#include "duet/batch/v1/dataset.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

using ::testing::_;

motion::Skeleton Stick() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"top", "hips", "bottom"};
  skeleton.bones = {{1, 0}, {1, 2}};
  skeleton.root = 1;
  return skeleton;
}

ModelInfo Model(const std::string& name, std::vector<std::string> classes) {
  ModelInfo model;
  model.name = name;
  model.version = 2;
  model.interaction_classes = std::move(classes);
  model.frame_rate_hz = 15;
  model.samples = true;
  model.terms = "For research only.";
  model.free_for_all_uses = true;
  model.weights_sha256 = "ab" + name;
  return model;
}

Recipe WithFormats(const std::vector<v1::Format>& formats) {
  Recipe recipe;
  recipe.digest = "cafe";
  for (const v1::Format format : formats) recipe.output.add_formats(format);
  return recipe;
}

// The set of `models` with these skeletons.
v1::Dataset Described(const Recipe& recipe, const std::vector<ModelInfo>& models,
                      const std::vector<motion::Skeleton>& skeletons, const SetCounts& counts,
                      int64_t planned = 0) {
  const std::string json = DatasetJson(SetSource{recipe, models, skeletons}, counts, planned);
  v1::Dataset dataset;
  const auto status = google::protobuf::util::JsonStringToMessage(json, &dataset);
  EXPECT_TRUE(status.ok()) << status.ToString() << "\n" << json;
  return dataset;
}

TEST(DatasetJson, ParsesAsTheProtoMessage) {
  SetCounts counts;
  counts.frames = 40;
  counts.items_by_rate = {{15, 1}, {30, 2}};
  counts.done = 3;
  counts.rejected = 2;
  counts.failed = 1;
  const v1::Dataset dataset =
      Described(WithFormats({v1::FORMAT_NPY, v1::FORMAT_BVH}),
                {Model("one", {"kick", "hug"}), Model("two", {"hug", "wave"})},
                {Stick(), motion::SbuSkeleton()}, counts, 10);
  EXPECT_EQ(dataset.format(), "duet-batch");
  EXPECT_EQ(dataset.format_version(), 1u);
  EXPECT_EQ(dataset.recipe_sha256(), "cafe");
  EXPECT_EQ(dataset.items().done(), 3u);
  EXPECT_EQ(dataset.items().missing(), 4u);
  EXPECT_EQ(dataset.frames(), 40u);
  EXPECT_FALSE(dataset.has_frame_rate_hz());
  ASSERT_EQ(dataset.frame_rates_size(), 2);
  EXPECT_EQ(dataset.frame_rates(1).frame_rate_hz(), 30);
  EXPECT_EQ(dataset.frame_rates(1).items(), 2u);
  ASSERT_EQ(dataset.skeletons_size(), 2);
  EXPECT_THAT(dataset.skeletons(0).joint_names(), ElementsAre("top", "hips", "bottom"));
  EXPECT_THAT(dataset.skeletons(0).parents(), ElementsAre(1, -1, 1));
  EXPECT_EQ(dataset.skeletons(0).root_joint(), "hips");
  ASSERT_EQ(dataset.models_size(), 2);
  EXPECT_EQ(dataset.models(1).name(), "two@2");
  EXPECT_EQ(dataset.models(1).skeleton(), 1u);
  EXPECT_EQ(dataset.models(1).terms(), "For research only.");
  EXPECT_TRUE(dataset.models(1).free_for_all_uses());
  EXPECT_EQ(dataset.models(1).weights_sha256(), "abtwo");
  EXPECT_TRUE(dataset.models(1).samples());
  EXPECT_THAT(dataset.interaction_classes(), ElementsAre("kick", "hug", "wave"));
  ASSERT_EQ(dataset.files_size(), 2);
  EXPECT_EQ(dataset.files(0).format(), v1::FORMAT_NPY);
  EXPECT_EQ(dataset.files(0).unit(), "metres");
  EXPECT_EQ(dataset.files(0).dtype(), "float32");
  EXPECT_THAT(dataset.files(0).shape(), ElementsAre("people", "frames", "joints", "coordinates"));
  EXPECT_THAT(dataset.files(1).endings(), ElementsAre(".leader.bvh", ".follower.bvh"));
  EXPECT_EQ(dataset.files(1).unit(), "centimetres");
  EXPECT_THAT(SkeletonIndices({Stick(), motion::SbuSkeleton(), Stick()}), ElementsAre(0, 1, 0));
  Recipe with_rate = WithFormats({v1::FORMAT_NPY});
  with_rate.output.set_frame_rate_hz(25);
  EXPECT_EQ(Described(with_rate, {Model("one", {"kick"})}, {Stick()}, {}).frame_rate_hz(), 25)
      << "before any item is done";
}

TEST(ParseRecord, ReadsLaterVersionsAndRejectsWhatIsNoRecord) {
  const auto record = ParseRecord(
      R"({"item": 0, "state": "done", "files": [{"path": "a.npy", "bytes": 12}], "later": [1, 2]})");
  ASSERT_THAT(record, IsOk());
  EXPECT_EQ(record->files(0).bytes(), 12u);
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const std::string& text :
       {std::string(), std::string("{\"state\": "), std::string("[]"), "{\"state\": " + deep + "}",
        std::string(R"({"state": "lost"})"), std::string(R"({"frames": "many"})")}) {
    EXPECT_THAT(ParseRecord(text), StatusIs(absl::StatusCode::kDataLoss, _)) << text.substr(0, 40);
  }
}

TEST(CheckWeights, DifferentWeightsAreRejected) {
  const auto identity = [](const std::string& sha256) {
    ModelInfo model = Model("one", {"kick"});
    model.weights_sha256 = sha256;
    return IdentityOf(WithFormats({v1::FORMAT_NPY}), {}, {model});
  };
  EXPECT_THAT(CheckWeights(identity("aa"), identity("bb")),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       HasSubstr("model one@2: expected the weights that the set was begun with "
                                 "(SHA-256 aa), got bb")));
  EXPECT_THAT(CheckWeights(identity("aa"), identity("aa")), IsOk());
  EXPECT_THAT(CheckWeights(identity("aa"), identity("")), IsOk()) << "a server without digests";
  EXPECT_THAT(CheckWeights({}, identity("aa")), IsOk()) << "a new set";
}

}  // namespace
}  // namespace duet::client::batch
