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

TEST(Plan, GoesThroughLeadersSidesReactionsModelsAndSamples) {
  const std::string kick = kKick;
  const struct {
    std::string recipe;
    std::vector<ModelInfo> models;
    std::vector<std::string> names;
  } cases[] = {
      {kick + "models: 'sbu' models: 'k3hi' samples: 2",
       {Model("sbu"), Model("k3hi")},
       {"a-2-kick-sbu_2-s0", "a-2-kick-sbu_2-s1", "a-2-kick-k3hi_2-s0", "a-2-kick-k3hi_2-s1"}},
      {"reactions { each_class {} } reactions { name: 'm' mixes { count: 2 } }",
       {Model("sbu")},
       {"a-2-kick", "a-2-push", "a-2-hug", "a-2-m0", "a-2-m1"}},
      {kick + "input { side: SIDE_BOTH }", {Model("sbu")}, {"a-2-left-kick", "a-2-right-kick"}}};
  for (const auto& [recipe, models, names] : cases) {
    const auto items = PlanOf(recipe, "leader\na.bvh\n", models);
    ASSERT_THAT(items, IsOk());
    EXPECT_EQ(Names(*items), names);
    for (size_t i = 0; i < items->size(); ++i) {
      EXPECT_EQ((*items)[i].number, static_cast<int64_t>(i));
    }
  }
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

TEST(Plan, SeedsAndMixesFollowTheContentOrTheIdAndNotThePath) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "walks");
  test::WriteTestFile(folder / "walks/a.bvh", "a walk");
  test::WriteTestFile(folder / "walks/b.bvh", "another walk");
  std::filesystem::create_directory_symlink(folder / "walks", folder / "link");
  // What decides about the items of a leader that is listed in a way: seeds and labels.
  const auto drawn = [&](const std::string& way, const std::string& id = "",
                         const std::string& content = "content") {
    std::string list = absl::StrCat("leader\n", (folder / way).string(), "\n");
    if (!id.empty()) list = absl::StrCat("leader\tid\n", (folder / way).string(), "\t", id, "\n");
    const auto items =
        PlanOf(absl::StrCat(kKick, " reactions { mixes { count: 2 } } samples: 2"), list);
    std::vector<std::string> found;
    for (const Item& item : *items) {
      found.push_back(absl::StrCat(SeedOf(item, 7, content, 0), " ", NameOfLabels(item.labels)));
    }
    return found;
  };
  const auto first = drawn("walks/a.bvh");
  EXPECT_EQ(std::set<std::string>(first.begin(), first.end()).size(), 6u)
      << "each has its own seed";
  for (const char* way : {"walks/./a.bvh", "link/../walks/a.bvh", "link/a.bvh"}) {
    EXPECT_EQ(drawn(way), first) << way;
  }
  EXPECT_NE(drawn("walks/b.bvh")[2], first[2]);
  EXPECT_NE(drawn("walks/a.bvh", "", "other"), first);
  EXPECT_EQ(drawn("walks/a.bvh", "one"), drawn("link/a.bvh", "one"));
  EXPECT_NE(drawn("walks/a.bvh", "one"), drawn("walks/a.bvh", "two"));
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
