#include "client/batch/dataset_json.h"

#include <google/protobuf/util/json_util.h>

#include <string>
#include <vector>

#include "client/batch/setup.h"
#include "duet/batch/v1/dataset.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

namespace v1 = ::duet::batch::v1;

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

Recipe WithFormats(std::vector<Format> formats) {
  Recipe recipe;
  recipe.digest = "cafe";
  recipe.output.formats = std::move(formats);
  return recipe;
}

nlohmann::ordered_json Done(int frames, double rate_hz, const std::string& shard = "") {
  nlohmann::ordered_json record = {{"frames", frames}, {"frame_rate_hz", rate_hz}};
  if (!shard.empty()) record["shard"] = shard;
  return record;
}

v1::Dataset Parsed(const std::string& json) {
  v1::Dataset dataset;
  const auto status = google::protobuf::util::JsonStringToMessage(json, &dataset);
  EXPECT_TRUE(status.ok()) << status.ToString() << "\n" << json;
  return dataset;
}

TEST(DatasetJson, ParsesAsTheProtoMessage) {
  const JobIdentity identity =
      WithModels(IdentityOf(WithFormats({Format::kNpy, Format::kBvh}), {}),
                 {Model("one", {"kick", "hug"}), Model("two", {"hug", "wave"})},
                 {Stick(), motion::SbuSkeleton()});
  DoneItems done;
  done.Add(Done(30, 15));
  done.Add(Done(7, 30));
  done.Add(Done(3, 30));
  SetCounts counts;
  counts.done = 3;
  counts.rejected = 2;
  counts.failed = 1;
  const v1::Dataset dataset = Parsed(DatasetJson(identity, counts, 10, done, false));
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
  EXPECT_EQ(dataset.packing(), v1::PACKING_NONE);
  EXPECT_THAT(dataset.shards(), IsEmpty());
}

TEST(DatasetJson, StatesTheCommonFrameRate) {
  const JobIdentity identity =
      WithModels(IdentityOf(WithFormats({Format::kNpy}), {}), {Model("one", {"kick"})}, {Stick()});
  DoneItems done;
  done.Add(Done(30, 60));
  done.Add(Done(30, 60));
  EXPECT_EQ(Parsed(DatasetJson(identity, {}, 0, done, false)).frame_rate_hz(), 60);
}

TEST(DatasetJson, RecipesFrameRateIsStatedBeforeAnyItemIsDone) {
  Recipe recipe = WithFormats({Format::kNpy});
  recipe.output.frame_rate_hz = 25;
  const JobIdentity identity =
      WithModels(IdentityOf(recipe, {}), {Model("one", {"kick"})}, {Stick()});
  EXPECT_EQ(Parsed(DatasetJson(identity, {}, 0, {}, false)).frame_rate_hz(), 25);
}

TEST(DatasetJson, NamesTheShardsOfAPackedSet) {
  Recipe recipe = WithFormats({Format::kNpy});
  recipe.output.packing = Packing::kTar;
  const JobIdentity identity =
      WithModels(IdentityOf(recipe, {}), {Model("one", {"kick"})}, {Stick()});
  DoneItems done;
  for (const char* shard : {"a.tar", "a.tar", "b.tar"}) done.Add(Done(30, 60, shard));
  const v1::Dataset packed = Parsed(DatasetJson(identity, {}, 0, done, true));
  EXPECT_EQ(packed.packing(), v1::PACKING_TAR);
  EXPECT_THAT(packed.shards(), ElementsAre("a.tar", "b.tar"));
  EXPECT_THAT(Parsed(DatasetJson(identity, {}, 0, done, false)).shards(), IsEmpty());
}

TEST(DatasetJson, SplitsHaveTheirItemsTablesAndShards) {
  Recipe recipe = WithFormats({Format::kNpy});
  recipe.splits = {0, 0.5};
  const JobIdentity identity =
      WithModels(IdentityOf(recipe, {}), {Model("one", {"kick"})}, {Stick()});
  DoneItems done;
  for (const char* split : {"train", "test", "train"}) {
    nlohmann::ordered_json record = Done(30, 60, std::string("set-") + split + ".tar");
    record["split"] = split;
    done.Add(record);
  }
  const v1::Dataset dataset = Parsed(DatasetJson(identity, {}, 0, done, true));
  ASSERT_EQ(dataset.splits_size(), 2);
  EXPECT_EQ(dataset.splits(0).name(), "train");
  EXPECT_EQ(dataset.splits(0).items(), 2u);
  EXPECT_EQ(dataset.splits(0).table(), "items/train.csv");
  EXPECT_THAT(dataset.splits(1).shards(), ElementsAre("set-test.tar"));
  EXPECT_THAT(dataset.shards(), ElementsAre("set-train.tar", "set-test.tar"));
}

TEST(DatasetJson, CapturesHaveTheirUnitAndRate) {
  Recipe recipe = WithFormats({});
  recipe.output.layout = Layout::kK3hi;
  const JobIdentity identity =
      WithModels(IdentityOf(recipe, {}), {Model("one", {"kick"})}, {motion::SbuSkeleton()});
  const v1::Dataset dataset = Parsed(DatasetJson(identity, {}, 0, {}, false));
  EXPECT_EQ(dataset.layout(), v1::LAYOUT_K3HI);
  EXPECT_EQ(dataset.frame_rate_hz(), 30);
  ASSERT_EQ(dataset.files_size(), 1);
  EXPECT_FALSE(dataset.files(0).has_format());
  EXPECT_EQ(dataset.files(0).unit(), "sbu-normalised");
  EXPECT_EQ(dataset.files(0).up_axis(), "y-down");
}

TEST(SkeletonIndices, ModelsOfOneSkeletonShareIt) {
  EXPECT_THAT(SkeletonIndices({Stick(), motion::SbuSkeleton(), Stick(), motion::SbuSkeleton()}),
              ElementsAre(0, 1, 0, 1));
}

TEST(SetDescriptionJson, IsReadBackAsItWas) {
  SetDescription description;
  description.models = {Describe(Model("one", {"kick"}))};
  description.formats = {Format::kCsv, Format::kUsda};
  description.frame_rate_hz = 12.5;
  description.splits = {0.25, 0.5};
  const nlohmann::json json = ToJson(description);
  const absl::StatusOr<SetDescription> read = SetDescriptionFromJson(json);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(nlohmann::json(ToJson(*read)), json);
  EXPECT_EQ(read->models[0].weights_sha256, "abone");
  EXPECT_EQ(read->models[0].free_for_all_uses, true);
  EXPECT_EQ(read->splits.test, 0.5);
  nlohmann::json bad = json;
  bad["formats"] = {"FORMAT_FBX"};
  EXPECT_THAT(SetDescriptionFromJson(bad),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected a format, got")));
}

class GoOnTest : public ::testing::Test {
 protected:
  static JobIdentity Identity(const std::string& sha256, const std::string& description) {
    ModelInfo model = Model("one", {"kick"});
    model.weights_sha256 = sha256;
    model.description = description;
    return WithModels(IdentityOf(WithFormats({Format::kNpy}), {}), {model}, {Stick()});
  }
};

TEST_F(GoOnTest, DifferentWeightsAreRejected) {
  EXPECT_THAT(GoOn(Identity("aa", ""), Identity("bb", "")),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       HasSubstr("model one@2: expected the weights that the set was begun with "
                                 "(SHA-256 aa), got bb")));
}

TEST_F(GoOnTest, OriginalDescriptionIsKept) {
  const auto identity = GoOn(Identity("aa", "before"), Identity("aa", "after"));
  ASSERT_THAT(identity, IsOk());
  EXPECT_EQ(identity->description.models[0].description, "before");
}

TEST_F(GoOnTest, ServerWithoutDigestsAndNewSetAreAccepted) {
  EXPECT_THAT(GoOn(Identity("aa", ""), Identity("", "")), IsOk());
  const auto fresh = GoOn({}, Identity("aa", "new"));
  ASSERT_THAT(fresh, IsOk());
  EXPECT_EQ(fresh->description.models[0].description, "new");
}

}  // namespace
}  // namespace duet::client::batch
