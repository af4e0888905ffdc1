#include "client/batch/recipe_difference.h"

#include "client/batch/recipe_file.h"
#include "gtest/gtest.h"
#include "tests/support/status_matchers.h"

namespace duet::client::batch {
namespace {

std::string Json(const std::string& recipe) {
  const absl::StatusOr<Recipe> parsed = ParseRecipe(recipe, false);
  EXPECT_THAT(parsed, test::IsOk());
  return parsed.ok() ? parsed->json : "";
}

constexpr char kBefore[] = R"(
  seed: 7 reactions { labels { weights { key: "kick" value: 1 } } } output { formats: FORMAT_NPY })";

TEST(DescribeDifference, NamesTheFieldAndBothValues) {
  EXPECT_EQ(DescribeDifference(Json(kBefore), Json(kBefore)), "");
  EXPECT_EQ(DescribeDifference(Json(kBefore), Json(R"(
    seed: 8 reactions { labels { weights { key: "kick" value: 0.5 } } }
    output { formats: FORMAT_NPY formats: FORMAT_CSV })")),
            "output.formats[1]: expected none, got \"FORMAT_CSV\"; "
            "reactions[0].labels.weights.kick: expected 1, got 0.5; "
            "seed: expected \"7\", got \"8\"");
}

TEST(DescribeDifference, CountsUnlistedDifferences) {
  EXPECT_EQ(DescribeDifference("{}", R"({"a":1,"b":2,"c":3,"d":4,"e":5,"f":6,"g":[1,2]})"),
            "a: expected none, got 1; b: expected none, got 2; c: expected none, got 3; "
            "d: expected none, got 4; e: expected none, got 5; and 3 more");
}

TEST(DescribeDifference, IsEmptyForInvalidRecipes) {
  EXPECT_EQ(DescribeDifference("", Json(kBefore)), "");
  EXPECT_EQ(DescribeDifference("[1]", Json(kBefore)), "");
}

}  // namespace
}  // namespace duet::client::batch
