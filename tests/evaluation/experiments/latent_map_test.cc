#include "model/evaluation/experiments/latent_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/status_matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::IsOk;
using test::StatusIs;

// Two groups of ten on lines far apart.
metrics::FeatureSet TwoGroups() {
  metrics::FeatureSet features;
  for (int i = 0; i < 20; ++i) {
    features.push_back({static_cast<float>(i % 10), i < 10 ? 0.0f : 100.0f, 1});
  }
  return features;
}

std::vector<int> Classes() {
  std::vector<int> classes(20, 0);
  std::fill(classes.begin() + 10, classes.end(), 1);
  return classes;
}

TEST(MapLatentTest, MeasuresGroupsInTheSpaceAndInTheMap) {
  metrics::TsneOptions options;
  options.perplexity = 30;  // more than 20 samples allow
  const absl::StatusOr<LatentMap> map = MapLatent(TwoGroups(), Classes(), options);
  ASSERT_THAT(map, IsOk());
  EXPECT_EQ(map->points.size(), 20u);
  EXPECT_EQ(map->purity_of_map, 1);
  EXPECT_EQ(map->nearest_neighbour, 1);
  EXPECT_EQ(map->several_neighbours, 1);
  std::vector<int> alternating(20);
  for (size_t i = 0; i < 20; ++i) alternating[i] = static_cast<int>(i % 2);
  EXPECT_LT(MapLatent(TwoGroups(), alternating, options)->nearest_neighbour, 0.2);
}

TEST(MapLatentTest, RefusesTooFewSamples) {
  EXPECT_THAT(MapLatent({{0}, {1}, {2}}, {0, 0, 1}, {}),
              StatusIs(absl::StatusCode::kInvalidArgument, testing::HasSubstr("wanted 6 or more")));
}

}  // namespace
}  // namespace duet::evaluation::experiments
