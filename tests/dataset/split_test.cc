#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "model/dataset/dataset.h"
#include "tests/support/matchers.h"

namespace duet::dataset {
namespace {

// `counts[c]` sequences of class c.
Dataset MadeUp(const std::vector<int>& counts) {
  Dataset dataset;
  dataset.name = "made up";
  for (size_t c = 0; c < counts.size(); ++c) {
    dataset.classes.push_back("class" + std::to_string(c));
    for (int i = 0; i < counts[c]; ++i) {
      Sequence sequence;
      sequence.interaction_class = static_cast<int>(c);
      dataset.sequences.push_back(sequence);
    }
  }
  return dataset;
}

std::vector<int> All(const Dataset& dataset) {
  std::vector<int> all(dataset.sequences.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::map<int, int> CountByClass(const Dataset& dataset, const std::vector<int>& indices) {
  std::map<int, int> count;
  for (int i : indices) ++count[dataset.sequences[static_cast<size_t>(i)].interaction_class];
  return count;
}

TEST(LeaveSubjectOutTest, TestsOnEitherPlace) {
  Dataset dataset = MadeUp({4});
  dataset.sequences[0].subjects = {"a", "b"};
  dataset.sequences[1].subjects = {"b", "c"};
  dataset.sequences[2].subjects = {"c", "a"};
  dataset.sequences[3].subjects = {"c", "b"};
  const absl::StatusOr<Split> split = LeaveSubjectOut(dataset, "a");
  ASSERT_TRUE(split.ok()) << split.status();
  EXPECT_THAT(split->test, ElementsAre(0, 2));
  EXPECT_THAT(split->train, ElementsAre(1, 3));
  const absl::Status unknown = LeaveSubjectOut(dataset, "z").status();
  EXPECT_EQ(unknown.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(unknown.message()),
              HasSubstr("expected one of made up's: a, b, c, got \"z\""));
}

TEST(SplitInHalvesTest, HalvesEachClass) {
  const Dataset dataset = MadeUp({20, 7, 2});
  const absl::StatusOr<Split> split = SplitInHalves(dataset, 5);
  ASSERT_TRUE(split.ok()) << split.status();
  EXPECT_EQ(CountByClass(dataset, split->train), (std::map<int, int>{{0, 10}, {1, 4}, {2, 1}}));
  EXPECT_EQ(CountByClass(dataset, split->test), (std::map<int, int>{{0, 10}, {1, 3}, {2, 1}}));
  EXPECT_TRUE(std::is_sorted(split->train.begin(), split->train.end()));
  EXPECT_TRUE(std::is_sorted(split->test.begin(), split->test.end()));
  std::vector<int> together = split->train;
  together.insert(together.end(), split->test.begin(), split->test.end());
  std::sort(together.begin(), together.end());
  EXPECT_EQ(together, All(dataset));
}

TEST(TakeValidationTest, TakesTheFractionOfEachClass) {
  const Dataset dataset = MadeUp({20, 10, 3, 1});
  std::vector<int> train = All(dataset);
  const std::vector<int> validation = TakeValidation(dataset, 0.2, 5, &train);
  EXPECT_EQ(CountByClass(dataset, validation), (std::map<int, int>{{0, 4}, {1, 2}, {2, 1}}));
  EXPECT_EQ(CountByClass(dataset, train), (std::map<int, int>{{0, 16}, {1, 8}, {2, 2}, {3, 1}}));
  std::vector<int> together = train;
  together.insert(together.end(), validation.begin(), validation.end());
  std::sort(together.begin(), together.end());
  EXPECT_EQ(together, All(dataset));
}

TEST(TakeValidationTest, NeverTakesWhatIsNotInTrain) {
  const Dataset dataset = MadeUp({10});
  std::vector<int> train = {1, 3, 5, 7};
  const std::vector<int> validation = TakeValidation(dataset, 0.5, 1, &train);
  EXPECT_EQ(validation.size(), 2u);
  for (int i : validation) EXPECT_EQ(i % 2, 1);
  std::vector<int> none = {2, 4};
  EXPECT_TRUE(TakeValidation(dataset, 0, 1, &none).empty());
  EXPECT_THAT(none, ElementsAre(2, 4));
}

}  // namespace
}  // namespace duet::dataset
