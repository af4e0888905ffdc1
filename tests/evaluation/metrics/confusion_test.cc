#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/metrics/judged_scores.h"

namespace duet::evaluation::metrics {
namespace {

TEST(ConfusionTest, CountsAndAccuracies) {
  Confusion confusion(3);
  for (int i = 0; i < 3; ++i) confusion.Add(0, 0);
  confusion.Add(0, 1);
  confusion.Add(1, 2);
  confusion.Add(1, 1);
  EXPECT_EQ(confusion.count(0, 0), 3);
  EXPECT_EQ(confusion.count(0, 1), 1);
  EXPECT_EQ(confusion.count(1, 0), 0);
  EXPECT_DOUBLE_EQ(confusion.ClassAccuracy(0), 0.75);
  EXPECT_DOUBLE_EQ(confusion.ClassAccuracy(1), 0.5);
  EXPECT_TRUE(std::isnan(confusion.ClassAccuracy(2)));
  EXPECT_DOUBLE_EQ(confusion.Accuracy(), 4.0 / 6);
  EXPECT_DOUBLE_EQ(confusion.MeanClassAccuracy(), 0.625);
}

TEST(ConfusionTest, CountsTheLikeliestClassOfEachMotion) {
  Confusion confusion(2);
  confusion.AddLikeliest({0, 1, 1}, {{0.9f, 0.1f}, {0.2f, 0.8f}, {0.5f, 0.5f}});
  EXPECT_EQ(confusion.count(0, 0), 1);
  EXPECT_EQ(confusion.count(1, 1), 1);
  EXPECT_EQ(confusion.count(1, 0), 1);  // the first of equals
  EXPECT_EQ(confusion.ClassAccuracies(), (std::vector<double>{1, 0.5}));
}

TEST(ConfusionTest, HasNoAccuracyWithoutMotions) {
  EXPECT_TRUE(std::isnan(Confusion(2).Accuracy()));
  EXPECT_TRUE(std::isnan(Confusion(2).MeanClassAccuracy()));
}

}  // namespace
}  // namespace duet::evaluation::metrics
