#ifndef DUET_MODEL_ENGINE_LEADER_STATISTICS_H_
#define DUET_MODEL_ENGINE_LEADER_STATISTICS_H_

#include <string>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Mean and standard deviation of each feature of a model's training leaders.
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

// Computes the statistics of training leaders, each with at least one frame and no longer than a
// window. Deviations have a minimum (LeaderFeature::smallest_deviation), and so has the scale, so
// that a few similar leaders do not make all others unfamiliar. Requires at least one leader.
LeaderStatistics FitLeaderStatistics(const motion::Skeleton& skeleton,
                                     const std::vector<const motion::Poses*>& leaders,
                                     double frame_rate_hz);

// Returns the distance of a motion, no longer than a window, from the training leaders: the root
// mean square of the features' distances from their means in deviations, divided by the scale. A
// tenth of the training leaders have a distance above 1. Features that the statistics lack are
// ignored.
double Unfamiliarity(const LeaderStatistics& statistics, const motion::Skeleton& skeleton,
                     const motion::Poses& leader, double frame_rate_hz);

// Returns the smallest of the values that at least nine tenths of them do not exceed. Requires a
// value.
double NinthDecile(std::vector<double> values);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LEADER_STATISTICS_H_
