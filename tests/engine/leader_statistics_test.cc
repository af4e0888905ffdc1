#include "model/engine/leader_statistics.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "model/engine/leader_features.h"
#include "tests/engine/leader_motion.h"

namespace duet::engine {
namespace {

constexpr double kStatisticsRate = 15;
constexpr int kStatisticsFrames = 31;

// People who step forwards and stretch a hand, no two alike.
std::vector<motion::Poses> TrainingLeaders(int count) {
  std::vector<motion::Poses> leaders;
  for (int i = 0; i < count; ++i) {
    motion::Poses leader = Walking(kStatisticsFrames, 0.001 * (i % 7));
    for (int t = 0; t < kStatisticsFrames; ++t) {
      leader.at(t, 7).z += 0.002f * static_cast<float>(t * (i % 5) + i);
    }
    leaders.push_back(std::move(leader));
  }
  return leaders;
}

LeaderStatistics FitTo(const std::vector<motion::Poses>& leaders) {
  std::vector<const motion::Poses*> pointers;
  for (const motion::Poses& leader : leaders) pointers.push_back(&leader);
  return FitLeaderStatistics(PlainSkeleton(), pointers, kStatisticsRate);
}

double Far(const LeaderStatistics& statistics, const motion::Poses& leader) {
  return Unfamiliarity(statistics, PlainSkeleton(), leader, kStatisticsRate);
}

const LeaderStatistics::Feature& Named(const LeaderStatistics& statistics,
                                       const std::string& name) {
  return *std::find_if(statistics.features.begin(), statistics.features.end(),
                       [&](const auto& feature) { return feature.name == name; });
}

TEST(LeaderStatistics, AreMeanAndSpreadOfTheLeaders) {
  const LeaderStatistics statistics =
      FitTo({Standing(kStatisticsFrames), Walking(kStatisticsFrames, 1 / kStatisticsRate)});
  EXPECT_NEAR(Named(statistics, "root_path_speed").mean, 0.5, 1e-4);
  EXPECT_NEAR(Named(statistics, "root_path_speed").deviation, 0.5, 1e-4);
  EXPECT_NEAR(Named(statistics, "still_share").mean, 0.5, 1e-4);
  EXPECT_NEAR(Named(statistics, "bone_length").mean, 3.7 / 7, 1e-4);
}

TEST(LeaderStatistics, LeadersWhoAreAllAlikeLeaveRoomAroundThem) {
  for (const int count : {1, 3}) {
    const LeaderStatistics statistics = FitTo(
        std::vector<motion::Poses>(static_cast<std::size_t>(count), Standing(kStatisticsFrames)));
    for (const LeaderFeature& feature : LeaderFeatures(PlainSkeleton())) {
      EXPECT_EQ(Named(statistics, std::string(feature.name)).deviation, feature.smallest_deviation);
    }
    EXPECT_EQ(statistics.scale, 0.5);
    EXPECT_NEAR(Far(statistics, Standing(kStatisticsFrames)), 0, 1e-6);
  }
}

TEST(LeaderStatistics, ATenthOfTheTrainingLeadersIsFartherThanOne) {
  const std::vector<motion::Poses> leaders = TrainingLeaders(40);
  const LeaderStatistics statistics = FitTo(leaders);
  std::vector<double> far;
  for (const motion::Poses& leader : leaders) far.push_back(Far(statistics, leader));
  std::sort(far.begin(), far.end());
  EXPECT_NEAR(far[35], 1, 1e-9);
  EXPECT_GT(far[36], 1);
  EXPECT_LT(far.front(), 0.8);
}

TEST(LeaderStatistics, WhoMovesOtherwiseIsFarther) {
  const LeaderStatistics statistics = FitTo(TrainingLeaders(40));
  motion::Poses large = Standing(kStatisticsFrames), low = large;
  for (motion::Vec3& joint : large.all()) joint = joint * 1.3f;
  for (int t = 0; t < kStatisticsFrames; ++t) low.at(t, 4).y = low.at(t, 5).y = 0.5f;
  EXPECT_GT(Far(statistics, Walking(kStatisticsFrames, 1 / kStatisticsRate)), 2);
  EXPECT_GT(Far(statistics, large), 2);
  EXPECT_GT(Far(statistics, low), 2);
}

TEST(LeaderStatistics, TheSameTwiceAsFastIsFarther) {
  const std::vector<motion::Poses> leaders = TrainingLeaders(40);
  const LeaderStatistics statistics = FitTo(leaders);
  const motion::Poses& fast = leaders[34];  // a fast one already
  EXPECT_GT(Unfamiliarity(statistics, PlainSkeleton(), fast, 2 * kStatisticsRate),
            1.2 * Far(statistics, fast));
}

TEST(LeaderStatistics, RootMeanSquareOfTheFeaturesThatAreKnownByTheScale) {
  LeaderStatistics statistics;
  statistics.features = {{"root_path_speed", 0.5, 0.25}};
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kStatisticsRate)), 2, 1e-3);
  statistics.scale = 4;
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kStatisticsRate)), 0.5, 1e-3);
  statistics.features.push_back({"still_share", 1, 0.5});  // 2 deviations as well
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kStatisticsRate)), 0.5, 1e-3);
  statistics.features.push_back({"root_travel", 2, 1});  // none
  EXPECT_NEAR(Far(statistics, Walking(kStatisticsFrames, 1 / kStatisticsRate)),
              0.5 * std::sqrt(2.0 / 3), 1e-3);
}

TEST(LeaderStatistics, NinthDecileIsOneOfTheValues) {
  EXPECT_EQ(NinthDecile({5}), 5);
  EXPECT_EQ(NinthDecile({2, 1}), 2);
  EXPECT_EQ(NinthDecile({10, 9, 8, 7, 6, 5, 4, 3, 2, 1}), 9);
  EXPECT_EQ(NinthDecile({11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1}), 10);
}

}  // namespace
}  // namespace duet::engine
