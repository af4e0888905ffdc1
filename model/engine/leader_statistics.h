#ifndef DUET_MODEL_ENGINE_LEADER_STATISTICS_H_
#define DUET_MODEL_ENGINE_LEADER_STATISTICS_H_

#include <string>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// How the leaders moved that a model was trained on: mean and spread of each of their features.
struct LeaderStatistics {
  struct Feature {
    std::string name;  // one of LeaderFeatures
    double mean = 0;
    double deviation = 1;  // above 0
  };
  std::vector<Feature> features;
  // The distance that a tenth of the training leaders exceeds, in deviations: above 0.
  double scale = 1;
};

// Over training leaders, each no longer than a window and of a frame or more. Deviations have a
// floor (LeaderFeature::smallest_deviation), and so has the scale, so that a handful of leaders
// does not make everything else strange. Requires a leader.
LeaderStatistics FitLeaderStatistics(const motion::Skeleton& skeleton,
                                     const std::vector<const motion::Poses*>& leaders,
                                     double frame_rate_hz);

// How far a motion no longer than a window is from those leaders: the root mean square, over the
// features, of its distance from their mean in deviations, by the scale. 1: as far as the farthest
// tenth of them. Features that the statistics lack do not count.
double Unfamiliarity(const LeaderStatistics& statistics, const motion::Skeleton& skeleton,
                     const motion::Poses& leader, double frame_rate_hz);

// The value that at least nine tenths of the values do not exceed: one of them. Requires a value.
double NinthDecile(std::vector<double> values);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LEADER_STATISTICS_H_
