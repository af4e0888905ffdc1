#include "client/batch/plan.h"

#include <filesystem>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/batch/answer.h"
#include "client/batch/leaders.h"
#include "client/batch/recipe.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/motion/skeleton.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

ModelInfo Model(const std::string& name, bool samples = true) {
  ModelInfo model;
  model.name = name;
  model.version = 2;
  model.interaction_classes = {"kick", "push", "hug"};
  model.samples = samples;
  return model;
}

absl::StatusOr<Plan> MakePlan(const std::string& recipe_text, const std::string& manifest,
                              std::vector<ModelInfo> models) {
  absl::StatusOr<Recipe> recipe =
      ParseRecipe(recipe_text + " output { formats: FORMAT_NPY }", false);
  if (!recipe.ok()) return recipe.status();
  return Plan::Create(*std::move(recipe), std::move(models),
                      ReadManifest(std::make_unique<std::istringstream>(manifest), "", "m"));
}

absl::StatusOr<std::vector<Item>> PlanOf(const std::string& recipe_text,
                                         const std::string& manifest = "leader\na.bvh\nb.bvh\n",
                                         std::vector<ModelInfo> models = {Model("sbu")}) {
  absl::StatusOr<Plan> plan = MakePlan(recipe_text, manifest, std::move(models));
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

TEST(Plan, OnlySeveralCandidatesChangeTheItem) {
  const auto id = [](const std::string& more) {
    return (*PlanOf(kKick + more, "leader\na.bvh\n"))[0].id;
  };
  // The id of earlier versions, so that their sets can be continued.
  EXPECT_EQ(id(""), "54e9b2a470fe12910b8bf016da00fb89");
  EXPECT_EQ(id("candidates: 1"), id(""));
  EXPECT_NE(id("candidates: 4"), id(""));
  EXPECT_NE(id("candidates: 4"), id("candidates: 5"));
}

TEST(Plan, EveryKindOfReaction) {
  const auto items = PlanOf(R"(
    reactions { each_class {} }
    reactions { name: 'm' mixes { count: 2 classes_in_mix: 3 } })",
                            "leader\na.bvh\n");
  ASSERT_THAT(items, IsOk());
  EXPECT_THAT(Names(*items), ElementsAre("a-2-kick", "a-2-push", "a-2-hug", "a-2-m0", "a-2-m1"));
  EXPECT_EQ((*items)[3].labels.size(), 3u);
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

TEST(Plan, LabelsSideSeedAndGroupOfALineOverrideTheRecipe) {
  const auto items =
      PlanOf(std::string(kKick) + "samples: 2",
             "leader\tlabels\tseed\tleader_side\tgroup\na.bvh\thug=1,kick=0.5\t9\tright\tann\n");
  ASSERT_THAT(items, IsOk());
  EXPECT_THAT(Names(*items), ElementsAre("a-2-hug1+kick0p5-s0", "a-2-hug1+kick0p5-s1"));
  EXPECT_EQ((*items)[0].side, formats::Side::kRight);
  EXPECT_EQ((*items)[0].leader->group, "ann");
  EXPECT_THAT((*items)[0].leader->extra, ::testing::IsEmpty());
  EXPECT_EQ(SeedOf((*items)[1], 0, "content", 0), 10u);
  EXPECT_NE(SeedOf((*items)[1], 0, "content", 1), 10u);
}

TEST(Plan, SeedsDifferFromItemToItem) {
  const auto items = PlanOf(std::string(kKick) + "samples: 20");
  std::set<uint64_t> seeds;
  for (const Item& item : *items) {
    const std::string content = item.leader->given;
    EXPECT_LT(SeedOf(item, 0, content, 0), uint64_t{1} << 53);
    seeds.insert(SeedOf(item, 0, content, 0));
    seeds.insert(SeedOf(item, 0, content, 1));
    seeds.insert(SeedOf(item, 1, content, 0));
  }
  EXPECT_EQ(seeds.size(), 3 * items->size());
}

// Folders with the same leader in each, as different people list it.
class ListedLeaders : public ::testing::Test {
 protected:
  ListedLeaders() {
    std::filesystem::create_directory(folder_ / "walks");
    test::WriteTestFile(folder_ / "walks/a.bvh", "a walk");
    test::WriteTestFile(folder_ / "walks/b.bvh", "another walk");
    std::filesystem::create_directory_symlink(folder_ / "walks", folder_ / "link");
    ways_ = {(folder_ / "walks/a.bvh").string(), (folder_ / "walks/./a.bvh").string(),
             (folder_ / "link/../walks/a.bvh").string(), (folder_ / "link/a.bvh").string()};
  }
  // The items of one leader, which is the second of the list, so that its line has another number.
  std::vector<Item> Of(const std::string& recipe, const std::string& path,
                       const std::string& id = "") {
    const std::string other = (folder_ / "walks/b.bvh").string();
    const std::string list = id.empty() ? absl::StrCat("leader\n", other, "\n", path, "\n")
                                        : absl::StrCat("leader\tid\n", path, "\t", id, "\n");
    std::vector<Item> items = *PlanOf(recipe, list);
    const auto others = static_cast<std::ptrdiff_t>(items.size() / 2);
    if (id.empty()) items.erase(items.begin(), items.begin() + others);
    return items;
  }
  test::TemporaryFolder folder_;
  std::vector<std::string> ways_;
};

TEST_F(ListedLeaders, SeedsAndMixesFollowTheContentAndNotThePath) {
  const std::string recipe = absl::StrCat(kKick, " reactions { mixes { count: 2 } } samples: 2");
  const std::vector<Item> first = Of(recipe, ways_[0]);
  for (const std::string& way : ways_) {
    const std::vector<Item> items = Of(recipe, way);
    ASSERT_EQ(items.size(), 6u);
    for (size_t i = 0; i < items.size(); ++i) {
      EXPECT_EQ(SeedOf(items[i], 7, "content", 0), SeedOf(first[i], 7, "content", 0)) << way;
      EXPECT_NE(SeedOf(items[i], 7, "content", 0), SeedOf(first[i], 7, "other", 0)) << way;
      EXPECT_EQ(NameOfLabels(items[i].labels), NameOfLabels(first[i].labels)) << way;
    }
  }
  const std::vector<Item> other = Of(recipe, (folder_ / "walks/b.bvh").string());
  EXPECT_NE(NameOfLabels(other[2].labels), NameOfLabels(first[2].labels));
}

TEST_F(ListedLeaders, SeedsAndMixesFollowTheIdWhereThereIsOne) {
  const std::string recipe = absl::StrCat(kKick, " reactions { mixes { count: 1 } }");
  const std::vector<Item> one = Of(recipe, ways_[0], "one"), again = Of(recipe, ways_[3], "one"),
                          two = Of(recipe, ways_[0], "two");
  EXPECT_EQ(SeedOf(one[0], 7, "content", 0), SeedOf(again[0], 7, "content", 0));
  EXPECT_NE(SeedOf(one[0], 7, "content", 0), SeedOf(two[0], 7, "content", 0));
  EXPECT_EQ(NameOfLabels(one[1].labels), NameOfLabels(again[1].labels));
  EXPECT_NE(NameOfLabels(one[1].labels), NameOfLabels(two[1].labels));
}

TEST_F(ListedLeaders, FollowersStartCountsByItsContentToo) {
  const auto seed = [this](const std::string& start, const std::string& content) {
    const std::string list = absl::StrCat("leader\tfollower_start\n", ways_[0], "\t", start, "\n");
    return SeedOf((*PlanOf(kKick, list))[0], 7, content, 0);
  };
  EXPECT_EQ(seed(ways_[1], "content"), seed(ways_[2], "content"));
  EXPECT_NE(seed(ways_[1], "content"), seed(ways_[1], "content and another start"));
  EXPECT_NE(seed("1,0,1", "content"), seed("1,0,2", "content"));
}

TEST(Plan, BothSidesLead) {
  const auto items = PlanOf(std::string("input { side: SIDE_BOTH } ") + kKick, "leader\na.bvh\n");
  ASSERT_THAT(items, IsOk());
  EXPECT_THAT(Names(*items), ElementsAre("a-2-left-kick", "a-2-right-kick"));
  EXPECT_EQ((*items)[1].side, formats::Side::kRight);
}

TEST(Plan, InvalidCombinationsAreRejected) {
  const auto refused = [](const char* message) {
    return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message));
  };
  EXPECT_THAT(PlanOf("reactions { labels { weights { key: 'waltz' value: 1 } } }"),
              refused("expected a class of sbu@2, got \"waltz\""));
  EXPECT_THAT(PlanOf(std::string(kKick) + kKick),
              refused("expected different names, got kick twice"));
  EXPECT_THAT(PlanOf("reactions { mixes { count: 1 } } reactions { mixes { count: 1 } }"),
              refused("expected a name for each of several mixes"));
  EXPECT_THAT(PlanOf("reactions { mixes { count: 1 classes_in_mix: 4 } }"),
              refused("at most the 3"));
  EXPECT_THAT(PlanOf(std::string(kKick) + "samples: 2", "leader\na.bvh\n", {Model("sbu", false)}),
              refused("has one answer"));
  EXPECT_THAT(PlanOf(""), refused("m:2: labels: expected some, since the recipe has no reactions"));
  EXPECT_THAT(PlanOf(kKick, "leader\tlabels\na.bvh\twaltz=1\n"),
              refused("m:2: labels: expected classes of sbu@2 (kick, push, hug), got \"waltz\""));
}

TEST(ToRequest, IsBulkAndNamedByTheItem) {
  const Item item = (*PlanOf(kKick))[0];
  const SynthesisRequest request = ToRequest(item, Recipe(), Model("sbu"), LoadedLeader(), 0);
  EXPECT_EQ(request.priority, Priority::kBulk);
  EXPECT_EQ(request.request_id, "batch-" + item.id);
  EXPECT_EQ(ToRequest(item, Recipe(), Model("sbu"), LoadedLeader(), 2).request_id,
            "batch-" + item.id + "-2");
}

TEST(Shard, EveryItemBelongsToOneShardOfSimilarSize) {
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

TEST(Plan, NamesThatFileSystemsCannotHoldAreRejected) {
  const auto named = [](const std::string& id) {
    return PlanOf(kKick, "leader\tid\na.bvh\t" + id + "\n").status();
  };
  EXPECT_THAT(named(std::string(195, 'x')), IsOk());
  EXPECT_THAT(named("walks/" + std::string(196, 'x')),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("m:2: name: expected at most 1000 bytes in parts of 200, got 207 "
                                 "in parts of 201")));
  std::string deep = "b";
  for (int i = 0; i < 600; ++i) deep += "/b";
  EXPECT_THAT(named(deep),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("in parts of 6")));
}

// Two items of each leader.
absl::StatusOr<PlanCheck> Check(const std::string& manifest, const PlanPart& part,
                                std::vector<int64_t>* visited, bool stopped = false) {
  absl::StatusOr<Plan> plan = MakePlan(std::string(kKick) + "samples: 2", manifest, {Model("sbu")});
  EXPECT_THAT(plan, IsOk());
  const auto visit = [visited](const Item& item) {
    visited->push_back(item.number);
    return item.leader->given == "changed.csv" ? absl::FailedPreconditionError("changed")
                                               : absl::OkStatus();
  };
  return CheckPlan(part, &*plan, visit, [stopped] { return stopped; });
}

TEST(CheckPlan, VisitsThePartAndNamesEveryBadLine) {
  PlanPart two;
  two.limit = 2;
  const struct {
    const char* manifest;
    PlanPart part;
    int64_t items, leaders;
    std::vector<std::string> bad_lines;
    std::vector<int64_t> visited;
  } cases[] = {
      {"leader\na.csv\nb.csv\na.csv\n", {}, 6, 3, {}, {0, 1, 2, 3, 4, 5}},
      {"leader\na.csv\nb.csv\n", two, 2, 1, {}, {0, 1}},
      {"a.csv\nb.csv\n", {}, 0, 0, {"m:1: columns: expected leader"}, {}},
      // A bad line shifts the numbers of the items after it, so they are not compared with a
      // journal.
      {"leader\tseed\na.csv\t1\nb.csv\tx\nc.csv\t2\nd.csv\n",
       {},
       4,
       2,
       {"m:3: seed: expected a whole number", "m:5: columns: expected 2 as the first line names"},
       {0, 1}},
      // The id of a bad line is taken.
      {"leader\tid\tseed\na.csv\tx\t-1\nb.csv\tx\t1\n",
       {},
       0,
       0,
       {"m:2: seed", "m:3: id: expected one that no other line has, got \"x\""},
       {}},
  };
  for (const auto& one : cases) {
    std::vector<int64_t> visited;
    const auto check = Check(one.manifest, one.part, &visited);
    ASSERT_THAT(check, IsOk()) << one.manifest;
    EXPECT_EQ(check->items, one.items) << one.manifest;
    EXPECT_EQ(check->leaders, one.leaders) << one.manifest;
    EXPECT_EQ(visited, one.visited) << one.manifest;
    ASSERT_EQ(check->bad_lines.size(), one.bad_lines.size()) << one.manifest;
    std::string all = BadLinesError(*check).ToString();
    for (const std::string& line : one.bad_lines) EXPECT_THAT(all, HasSubstr("\n  " + line));
  }
}

TEST(CheckPlan, EndsWithTheErrorOfAVisitAndWhenItIsStopped) {
  std::vector<int64_t> visited;
  EXPECT_THAT(Check("leader\nchanged.csv\n", {}, &visited),
              StatusIs(absl::StatusCode::kFailedPrecondition, "changed"));
  EXPECT_EQ(Check("leader\na.csv\n", {}, &visited, /*stopped=*/true)->items, 0);
}

}  // namespace
}  // namespace duet::client::batch
