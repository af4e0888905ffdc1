#include "model/evaluation/report/latent_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"

namespace duet::evaluation::report {
namespace {

// Two groups of ten on lines far apart.
metrics::FeatureSet TwoGroups() {
  metrics::FeatureSet features;
  for (int i = 0; i < 20; ++i) {
    features.push_back({static_cast<float>(i % 10), i < 10 ? 0.0f : 100.0f, 1});
  }
  return features;
}

TEST(LatentTableTest, RowHasTheSharesOfOneAndOfFiveNeighbours) {
  EXPECT_THAT(LatentTable().columns, ElementsAre("1 in the space", "5 in the space"));
  std::vector<int> classes(20, 0);
  std::fill(classes.begin() + 10, classes.end(), 1);
  const absl::StatusOr<TableRow> row = LatentRow("ours", TwoGroups(), classes);
  ASSERT_THAT(row, IsOk());
  EXPECT_EQ(row->name, "ours");
  EXPECT_THAT(row->values, ElementsAre(1, 1));
  for (size_t i = 0; i < 20; ++i) classes[i] = static_cast<int>(i % 2);
  EXPECT_LT(LatentRow("ours", TwoGroups(), classes)->values[0], 0.2);
}

TEST(LatentTableTest, TooFewSamplesAreRejected) {
  EXPECT_THAT(LatentRow("ours", {{0}, {1}, {2}}, {0, 0, 1}),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       testing::HasSubstr("expected at least 6 vectors, got 3")));
}

}  // namespace
}  // namespace duet::evaluation::report
