#include "client/batch/recipe.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

// Of recipes that say nothing of it.
constexpr char kOutput[] = " output { formats: FORMAT_NPY }";

absl::StatusOr<Recipe> Parse(const std::string& text) {
  const bool has_output = text.find("output") != std::string::npos;
  return ParseRecipe(has_output ? text : text + kOutput, /*json=*/false);
}

TEST(Recipe, TextFormatAndJsonAreEquivalent) {
  const auto text = Parse(R"(
    seed: 3 models: "sbu@2" variety: 0.5 candidates: 4
    reactions { labels { weights { key: "kick" value: 1 } weights { key: "hug" value: -0.5 } } }
    filter { max_lean_degrees: 30 max_twisted: 0.1 max_overlapping: 0.2
             max_skating_over_leader: 0.3 retries_per_item: 2 })");
  const auto json = ParseRecipe(R"({
    "seed": 3, "models": ["sbu@2"], "variety": 0.5, "candidates": 4,
    "reactions": [{"labels": {"weights": {"hug": -0.5, "kick": 1}}}],
    "filter": {"max_lean_degrees": 30, "max_twisted": 0.1, "max_overlapping": 0.2,
               "max_skating_over_leader": 0.3, "retries_per_item": 2},
    "output": {"formats": ["FORMAT_NPY"]}})",
                                /*json=*/true);
  ASSERT_THAT(text, IsOk());
  ASSERT_THAT(json, IsOk());
  EXPECT_EQ(text->digest, json->digest);
  const Labels labels = ToLabels(text->reactions[0].labels());
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[0].interaction_class, "hug");
  EXPECT_EQ(labels[0].weight, -0.5f);
  EXPECT_EQ(text->models[0].version, 2);
  EXPECT_EQ(text->candidates, 4);
  EXPECT_EQ(text->filter.max_lean_degrees(), 30);
  EXPECT_EQ(text->filter.max_twisted(), 0.1);
  EXPECT_EQ(text->filter.max_overlapping(), 0.2);
  EXPECT_EQ(text->filter.max_skating_over_leader(), 0.3);
  EXPECT_EQ(text->filter.retries_per_item(), 2);
}

struct BadRecipe {
  const char* text;
  const char* message;
  const char* got;
};

class BadRecipes : public ::testing::TestWithParam<BadRecipe> {};

TEST_P(BadRecipes, AreRejectedWithTheFieldAndItsValue) {
  EXPECT_THAT(Parse(GetParam().text),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr(GetParam().message), HasSubstr(GetParam().got))));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadRecipes,
    ::testing::Values(
        BadRecipe{"colour: 1", "line 1", ""},
        BadRecipe{"reactions {}", "reactions[0]: expected one of labels", ", got nothing"},
        BadRecipe{"reactions { labels {} }", "reactions[0].labels.weights: expected", ", got none"},
        BadRecipe{"reactions { labels { weights { key: 'a' value: 3 } } }",
                  "weights[a]: expected a number from -2 to 2", ", got 3"},
        // Names may be anything: the message is one short line.
        BadRecipe{"reactions { labels { weights { key: 'a\\000\\n' value: 3 } } }",
                  "weights[a\\x00\\n]: expected a number", ", got 3"},
        BadRecipe{"models: 'a' reactions { each_class { classes: '\\033' classes: '\\033' } }",
                  "each_class.classes: expected", ", got \\x1b twice"},
        BadRecipe{"reactions { mixes {} }", "mixes.count: expected", ", got 0"},
        BadRecipe{"reactions { mixes { count: 1 classes: 'a' } }", "classes_in_mix: expected",
                  ", got 2"},
        BadRecipe{"reactions { mixes { count: 1 min_weight: 2 } }", "min_weight: expected",
                  ", got 2"},
        BadRecipe{"reactions { each_class { beside {} } }", "beside", ""},
        BadRecipe{"reactions { name: 'a-b' each_class {} }", "name: expected", ", got \"a-b\""},
        BadRecipe{"samples: 0", "samples: expected a number from 1", ", got 0"},
        BadRecipe{"variety: 3", "variety: expected", ", got 3"},
        BadRecipe{"candidates: 17", "candidates: expected a number from 1 to 16", ", got 17"},
        BadRecipe{"filter { max_twisted: -1 }", "filter.max_twisted: expected", ", got -1"},
        BadRecipe{"models: 'a@0'", "models: expected", ", got \"a@0\""},
        BadRecipe{"models: 'a' models: 'a'", "models: expected", ", got a twice"},
        BadRecipe{"filter { retries_per_item: 101 }", "retries_per_item: expected", ", got 101"},
        BadRecipe{"input { up: [0, 1] }", "input.up: expected X,Y,Z less than 45", ", got 0,1"},
        BadRecipe{"input { up: [0, 1, 2] }", "input.up: expected X,Y,Z less than 45",
                  ", got 0,1,2"},
        BadRecipe{"input { up: [0, nan, 0] }", "input.up: expected", ", got 0,nan,0"},
        BadRecipe{"input { frame_rate_hz: 0 }", "input.frame_rate_hz: expected", ", got 0"},
        BadRecipe{"output { formats: FORMAT_NPY frame_rate_hz: 0 }",
                  "output.frame_rate_hz: expected", ", got 0"},
        BadRecipe{"output { formats: FORMAT_NPY frame_rate_hz: nan }",
                  "output.frame_rate_hz: expected", ", got nan"},
        BadRecipe{"output { formats: FORMAT_NPY packing: PACKING_TAR }", "packing", ""},
        BadRecipe{"output { formats: FORMAT_NPY formats: FORMAT_NPY }", "formats: expected",
                  ", got 3 twice"}));

TEST(ReadRecipe, ErrorsNameTheFileAndExtensionSelectsTheFormat) {
  const test::TemporaryFolder folder;
  test::WriteTestFile(folder / "r.json", R"({"output": {"formats": ["FORMAT_BVH"]}})");
  EXPECT_THAT(ReadRecipe(folder / "r.json"), IsOk());
  test::WriteTestFile(folder / "r.textproto", "{}");
  EXPECT_THAT(ReadRecipe(folder / "r.textproto"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("r.textproto: line 1")));
}

std::string Json(const std::string& recipe) {
  const absl::StatusOr<Recipe> parsed = ParseRecipe(recipe, false);
  EXPECT_THAT(parsed, IsOk());
  return parsed.ok() ? parsed->json : "";
}

constexpr char kBefore[] = R"(
  seed: 7 reactions { labels { weights { key: "kick" value: 1 } } } output { formats: FORMAT_NPY })";

TEST(DescribeDifference, NamesTheFieldAndBothValues) {
  EXPECT_EQ(DescribeDifference(Json(kBefore), Json(kBefore)), "");
  EXPECT_EQ(DescribeDifference(Json(kBefore), Json(R"(
    seed: 8 reactions { labels { weights { key: "kick" value: 0.5 } } }
    output { formats: FORMAT_NPY formats: FORMAT_BVH })")),
            "modified: seed: 7 -> 8; modified: reactions[0].labels.weights[kick]: 1 -> 0.5; "
            "added: output.formats[1]: FORMAT_BVH");
}

}  // namespace
}  // namespace duet::client::batch
