#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_MEETING_GEOMETRY_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_MEETING_GEOMETRY_H_

#include <string>
#include <vector>

#include "model/body/limbs.h"
#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::evaluation::experiments {

// How a follower meets a leader, in numbers: how near it comes, what its hands do, how it recoils.
// Every feature is an extreme over the clip, and larger for more of it; therefore a mix can have
// the features of two classes at different times.
//
// Threads: const methods are safe to call concurrently.
class MeetingGeometry {
 public:
  // Requires a skeleton that Validate accepts.
  explicit MeetingGeometry(const motion::Skeleton& skeleton);

  // Whether the skeleton has hips, two arms, a chest and a head.
  bool possible() const;
  const body::Body& body() const { return body_; }

  static const std::vector<std::string>& Features();

  // Metres, and degrees for leaning. `away`: horizontal direction from leader to follower, of
  // length 1. Requires possible(), at least one frame, and a leader of as many frames.
  // Shapes: returns [features].
  std::vector<double> Measure(const motion::Poses& leader, const motion::Poses& follower,
                              motion::Vec3 away, double rate) const;

 private:
  motion::Skeleton skeleton_;
  body::Body body_;
};

// The horizontal direction, of length 1, from leader to follower in a capture's first frame.
motion::Vec3 AwayFromLeader(const dataset::Sequence& sequence, int root);

// The features of captured followers, by class. Shapes: [classes][features].
struct ClassGeometry {
  std::vector<std::vector<double>> means, deviations;

  // By how much the feature of a class exceeds that of another class, if this is more than their
  // spread; otherwise 0. A feature that exceeds it belongs to the class's own geometry.
  double Own(int of_class, int other, size_t feature) const;
};
ClassGeometry MeasureClasses(const MeetingGeometry& geometry, const dataset::Dataset& dataset,
                             const std::vector<int>& sequences);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_MEETING_GEOMETRY_H_
