#include "client/batch/plan.h"

#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "client/batch/answer.h"
#include "client/batch/manifest.h"
#include "client/batch/recipe_file.h"
#include "client/batch/shard.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/status_matchers.h"

namespace duet::client::batch {
namespace {

using test::IsOk;
using test::StatusIs;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

ModelInfo Model(const std::string& name, bool samples = true) {
  ModelInfo model;
  model.name = name;
  model.version = 2;
  model.interaction_classes = {"kick", "push", "hug"};
  model.samples = samples;
  return model;
}

absl::StatusOr<std::vector<Item>> PlanOf(const std::string& recipe_text,
                                         const std::string& manifest = "leader\na.bvh\nb.bvh\n",
                                         std::vector<ModelInfo> models = {Model("sbu")},
                                         const std::string& output = "") {
  absl::StatusOr<Recipe> recipe =
      ParseRecipe(recipe_text + " output { formats: FORMAT_NPY " + output + " }", false);
  if (!recipe.ok()) return recipe.status();
  std::istringstream in(manifest);
  absl::StatusOr<Plan> plan =
      Plan::Create(*std::move(recipe), std::move(models), ReadManifest(in, "", "m"));
  if (!plan.ok()) return plan.status();
  std::vector<Item> items;
  while (true) {
    absl::StatusOr<std::optional<Item>> item = plan->Next();
    if (!item.ok()) return item.status();
    if (!item->has_value()) return items;
    items.push_back(**std::move(item));
  }
}

std::vector<std::string> Names(const std::vector<Item>& items) {
  std::vector<std::string> names;
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

constexpr char kKick[] = "reactions { labels { weights { key: 'kick' value: 1 } } }";

TEST(Plan, GoesThroughLeadersReactionsModelsAndSamples) {
  const auto items = PlanOf(std::string(kKick) + "models: 'sbu' models: 'k3hi' samples: 2",
                            "leader\na.bvh\n", {Model("sbu"), Model("k3hi")});
  ASSERT_THAT(items, IsOk());
  EXPECT_THAT(Names(*items), ElementsAre("a-2-kick-sbu_2-s0", "a-2-kick-sbu_2-s1",
                                         "a-2-kick-k3hi_2-s0", "a-2-kick-k3hi_2-s1"));
  for (size_t i = 0; i < items->size(); ++i) EXPECT_EQ((*items)[i].number, static_cast<int64_t>(i));
}

TEST(Plan, EveryKindOfReaction) {
  const auto items = PlanOf(R"(
    reactions { grid { axes { interaction_class: 'kick' weights: 0.5 weights: 1 }
                       axes { interaction_class: 'hug' weights: -1 weights: 0 } } }
    reactions { each_class {} }
    reactions { name: 'turn' schedule { keyframes { at: 0 labels { weights { key: 'kick' value: 1 } } }
                                        keyframes { at: 1 labels { weights { key: 'hug' value: 1 } } } } }
    reactions { name: 'm' mixes { count: 2 classes_in_mix: 3 } })",
                            "leader\na.bvh\n");
  ASSERT_THAT(items, IsOk());
  EXPECT_THAT(Names(*items), ElementsAre("a-2-hugm1+kick0p5", "a-2-hug0+kick0p5", "a-2-hugm1+kick1",
                                         "a-2-hug0+kick1", "a-2-kick", "a-2-push", "a-2-hug",
                                         "a-2-turn", "a-2-m0", "a-2-m1"));
  EXPECT_EQ((*items)[7].keyframes.size(), 2u);
  EXPECT_EQ((*items)[8].labels.size(), 3u);
}

TEST(Plan, MixesDifferFromLeaderToLeaderAndNotFromRunToRun) {
  const std::string recipe = "seed: 4 reactions { mixes { count: 3 min_weight: 0.5 } }";
  const auto items = PlanOf(recipe), again = PlanOf(recipe),
             other = PlanOf("seed: 5" + recipe.substr(7));
  ASSERT_THAT(items, IsOk());
  std::set<std::string> mixes;
  for (size_t i = 0; i < items->size(); ++i) {
    const Item& item = (*items)[i];
    EXPECT_EQ(item.id, (*again)[i].id);
    EXPECT_NE(item.id, (*other)[i].id);
    ASSERT_EQ(item.labels.size(), 2u);
    EXPECT_NE(item.labels[0].interaction_class, item.labels[1].interaction_class);
    for (const ClassWeight& label : item.labels) {
      EXPECT_GE(label.weight, 0.5f);
      EXPECT_LE(label.weight, 1.0f);
    }
    mixes.insert(NameOfLabels(item.labels));
  }
  EXPECT_EQ(mixes.size(), 6u);
}

TEST(Plan, ALinesLabelsSeedAndModelWin) {
  const auto items = PlanOf(std::string(kKick) + "models: 'sbu' models: 'k3hi' samples: 2",
                            "leader\tlabels\tseed\tmodel\na.bvh\thug=1\t9\tk3hi@2\n",
                            {Model("sbu"), Model("k3hi")});
  ASSERT_THAT(items, IsOk());
  EXPECT_THAT(Names(*items), ElementsAre("a-2-hug-k3hi_2-s0", "a-2-hug-k3hi_2-s1"));
  EXPECT_EQ(SeedOf((*items)[1], 0, 0), 10u);
  EXPECT_NE(SeedOf((*items)[1], 0, 1), 10u);
}

TEST(Plan, SeedsDifferFromItemToItem) {
  const auto items = PlanOf(std::string(kKick) + "samples: 20");
  std::set<uint64_t> seeds;
  for (const Item& item : *items) {
    EXPECT_LT(SeedOf(item, 0, 0), uint64_t{1} << 53);
    seeds.insert(SeedOf(item, 0, 0));
    seeds.insert(SeedOf(item, 0, 1));
    seeds.insert(SeedOf(item, 1, 0));
  }
  EXPECT_EQ(seeds.size(), 3 * items->size());
}

TEST(Plan, BothSidesLeadAndClassFoldersGoByTheLargestWeight) {
  const auto items = PlanOf(
      "input { side: SIDE_BOTH } reactions { labels { "
      "weights { key: 'kick' value: 0.5 } weights { key: 'hug' value: 1 } } }",
      "leader\na.bvh\n", {Model("sbu")}, "layout: LAYOUT_CLASS_FOLDERS");
  ASSERT_THAT(items, IsOk());
  EXPECT_THAT(Names(*items),
              ElementsAre("hug/a-2-left-hug1+kick0p5", "hug/a-2-right-hug1+kick0p5"));
  EXPECT_EQ((*items)[1].side, formats::Side::kRight);
}

TEST(Plan, WhatMakesNoSenseIsRefused) {
  const auto refused = [](const char* message) {
    return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message));
  };
  EXPECT_THAT(PlanOf("reactions { labels { weights { key: 'waltz' value: 1 } } }"),
              refused("came class \"waltz\", wanted one of sbu@2's"));
  EXPECT_THAT(PlanOf(std::string(kKick) + kKick), refused("two are named kick"));
  EXPECT_THAT(PlanOf("reactions { mixes { count: 1 } } reactions { mixes { count: 1 } }"),
              refused("several mixes"));
  EXPECT_THAT(PlanOf("reactions { mixes { count: 1 classes_in_mix: 4 } }"),
              refused("at most the 3"));
  EXPECT_THAT(PlanOf(std::string(kKick) + "samples: 2", "leader\na.bvh\n", {Model("sbu", false)}),
              refused("has one answer"));
  EXPECT_THAT(PlanOf(""), refused("a.bvh: wanted labels in the manifest"));
  EXPECT_THAT(PlanOf(kKick, "leader\tmodel\na.bvh\tother\n"), refused("model: came \"other\""));
}

TEST(ToRequest, KeyframesFallOnFrames) {
  const auto items = PlanOf(
      "reactions { schedule { keyframes { at: 0 labels { weights { key: 'kick' value: 1 } } }"
      " keyframes { at: 0.5 labels { weights { key: 'push' value: 1 } } }"
      " keyframes { at: 1 labels { weights { key: 'hug' value: 1 } } } } }");
  ASSERT_THAT(items, IsOk());
  LoadedLeader leader;
  leader.clip.poses = motion::Poses(5, 1);
  const SynthesisRequest request = ToRequest((*items)[0], Recipe(), Model("sbu"), leader, 0);
  ASSERT_EQ(request.keyframes.size(), 3u);
  EXPECT_EQ(request.keyframes[1].frame, 2);
  EXPECT_EQ(request.keyframes[2].frame, 4);
  EXPECT_EQ(request.priority, Priority::kBulk);
  EXPECT_EQ(request.request_id, "batch-" + (*items)[0].id);
  leader.clip.poses = motion::Poses(1, 1);
  EXPECT_EQ(ToRequest((*items)[0], Recipe(), Model("sbu"), leader, 0).keyframes.size(), 1u);
}

TEST(Shard, EveryItemFallsToOneAndTheyAreAlike) {
  const auto items = PlanOf(std::string(kKick) + "samples: 500");
  std::vector<int> sizes(4);
  for (const Item& item : *items) {
    int owners = 0;
    for (int i = 0; i < 4; ++i) {
      if (!Shard{i, 4}.Has(item.id)) continue;
      ++owners;
      ++sizes[static_cast<size_t>(i)];
    }
    EXPECT_EQ(owners, 1);
  }
  for (const int size : sizes) EXPECT_NEAR(size, 250, 60);
}

TEST(Shard, IsParsedStrictly) {
  EXPECT_EQ(ParseShard("2/8")->index, 2);
  EXPECT_EQ(ParseShard("2/8")->count, 8);
  for (const char* bad : {"", "1", "8/8", "-1/8", "a/b", "1/0"}) {
    EXPECT_THAT(ParseShard(bad),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("INDEX/COUNT")));
  }
}

ReadVariable Environment(std::vector<std::pair<std::string, std::string>> variables) {
  return [variables = std::move(variables)](const char* name) -> std::optional<std::string> {
    for (const auto& [key, value] : variables) {
      if (key == name) return value;
    }
    return std::nullopt;
  };
}

TEST(Shard, IsFoundInAClustersEnvironment) {
  EXPECT_EQ(ShardFromEnvironment(Environment({}))->count, 1);
  const auto kubernetes =
      ShardFromEnvironment(Environment({{"JOB_COMPLETION_INDEX", "3"}, {"JOB_COMPLETIONS", "4"}}));
  EXPECT_EQ(kubernetes->index, 3);
  EXPECT_EQ(kubernetes->count, 4);
  const auto slurm = ShardFromEnvironment(Environment({{"SLURM_ARRAY_TASK_ID", "5"},
                                                       {"SLURM_ARRAY_TASK_MIN", "1"},
                                                       {"SLURM_ARRAY_TASK_COUNT", "8"}}));
  EXPECT_EQ(slurm->index, 4);
  const auto aws = ShardFromEnvironment(
      Environment({{"AWS_BATCH_JOB_ARRAY_INDEX", "1"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "2"}}));
  EXPECT_EQ(aws->index, 1);
  EXPECT_THAT(
      ShardFromEnvironment(Environment({{"JOB_COMPLETION_INDEX", "3"}})),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("JOB_COMPLETIONS: came none")));
  EXPECT_THAT(
      ShardFromEnvironment(Environment({{"JOB_COMPLETION_INDEX", "4"}, {"JOB_COMPLETIONS", "4"}})),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("wanted one of 4 from 0")));
}

}  // namespace
}  // namespace duet::client::batch
