#include "model/evaluation/metrics/tsne.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/status_matchers.h"

namespace duet::evaluation::metrics {
namespace {

using test::IsOk;
using test::StatusIs;

using testing::HasSubstr;

// `count` clusters of 20 samples in 10 dimensions: standard normal around corners 12 apart.
FeatureSet Clusters(int count, std::vector<int>* classes) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  FeatureSet features;
  for (int i = 0; i < 20 * count; ++i) {
    std::vector<float> one(10);
    for (float& value : one) value = normal(random);
    one[static_cast<size_t>(i % count)] += 12;
    features.push_back(one);
    classes->push_back(i % count);
  }
  return features;
}

TsneOptions Quick() {
  TsneOptions options;
  options.perplexity = 10;
  options.iterations = 400;
  return options;
}

TEST(TsneTest, KeepsSeparableClustersApart) {
  std::vector<int> classes;
  const FeatureSet features = Clusters(4, &classes);
  const auto map = Tsne(features, Quick());
  ASSERT_THAT(map, IsOk());
  EXPECT_EQ(NeighbourPurity(*map, classes), 1);
  // Each cluster is a lump: its spread is small beside the distance of cluster centres.
  std::vector<Point2> centres(4, Point2{0, 0});
  for (size_t i = 0; i < map->size(); ++i) {
    for (size_t k : {0u, 1u}) centres[static_cast<size_t>(classes[i])][k] += (*map)[i][k] / 20;
  }
  double widest = 0, closest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < map->size(); ++i) {
    const Point2& centre = centres[static_cast<size_t>(classes[i])];
    widest = std::max(widest, std::hypot((*map)[i][0] - centre[0], (*map)[i][1] - centre[1]));
  }
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < i; ++j) {
      closest = std::min(closest,
                         std::hypot(centres[i][0] - centres[j][0], centres[i][1] - centres[j][1]));
    }
  }
  EXPECT_GT(closest, widest);
}

TEST(TsneTest, TheSeedAloneDecides) {
  std::vector<int> classes;
  const FeatureSet features = Clusters(2, &classes);
  TsneOptions options = Quick();
  options.iterations = 50;
  const auto once = Tsne(features, options), again = Tsne(features, options);
  options.seed = 2;
  const auto other = Tsne(features, options);
  ASSERT_THAT(once, IsOk());
  EXPECT_EQ(*once, *again);
  EXPECT_NE(*once, *other);
}

TEST(TsneTest, ToleratesRepeatedSamples) {
  const FeatureSet features(12, {1, 2, 3});
  TsneOptions options = Quick();
  options.perplexity = 3;
  const auto map = Tsne(features, options);
  ASSERT_THAT(map, IsOk());
  for (const Point2& point : *map) EXPECT_TRUE(std::isfinite(point[0] + point[1]));
}

TEST(TsneTest, RefusesWhatItCannotMap) {
  std::vector<int> classes;
  const FeatureSet features = Clusters(2, &classes);
  const auto invalid = absl::StatusCode::kInvalidArgument;
  EXPECT_THAT(Tsne({{1}, {2}, {3}}), StatusIs(invalid, HasSubstr("3 samples")));
  EXPECT_THAT(Tsne({{1}, {2}, {3}, {4, 5}}), StatusIs(invalid, HasSubstr("features[3]: 2 values")));
  EXPECT_THAT(Tsne({{1}, {2}, {std::nanf("")}, {4}}),
              StatusIs(invalid, HasSubstr("features[2]: not finite")));
  TsneOptions options;
  options.perplexity = 14;
  EXPECT_THAT(Tsne(features, options),
              StatusIs(invalid, HasSubstr("perplexity: 14, wanted 1 to 13")));
}

TEST(NeighbourPurityTest, CountsNearestNeighboursOfTheSameClass) {
  // On a line: a a b b a. The last one's nearest is a b.
  const std::vector<Point2> points = {{0, 0}, {1, 0}, {10, 0}, {11, 0}, {13, 0}};
  EXPECT_DOUBLE_EQ(NeighbourPurity(points, {0, 0, 1, 1, 0}), 0.8);
}

}  // namespace
}  // namespace duet::evaluation::metrics
