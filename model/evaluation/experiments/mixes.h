#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_MIXES_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_MIXES_H_

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "model/body/limbs.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/report/table.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// What mixing and avoiding classes does to the answers to a leader. All answers to one leader have
// one seed and one start, so that only the labels differ.

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

// An answer to two classes at once, and the answers to each of them by itself.
struct MixedAnswer {
  int leader = 0;
  int fold = 0;            // of the captures that say what belongs to a class
  int own = 0, other = 0;  // the class of the leader's interaction, and the one that is added
  // Of the mix and of the two single answers. Shapes: [features] of MeetingGeometry.
  std::vector<double> mixed = {}, own_alone = {}, other_alone = {};
  std::vector<float> probabilities = {};             // the judge's of the mix [classes]
  double deviation = 0;                              // Deviation's
  double twisted = 0, overlapping = 0, skating = 0;  // shares of frames (body::Grade)
  // The largest move of a joint in any frame when a weight moves by 0.1; NaN: not measured.
  double largest_move = NAN;
};

// The distance of a mix from the average of both single answers, over that of either single answer
// from it: 0 for the average, 1 for a single answer. NaN if the single answers are the same.
double Deviation(const motion::Poses& mixed, const motion::Poses& own, const motion::Poses& other);

// The largest distance of a joint in one frame from the same joint in the other motion, metres.
double LargestMove(const motion::Poses& before, const motion::Poses& after);

// How much of each class's own geometry a mix keeps: 0 as in the other class's single answer, 1 as
// in its own; the mean over the features that are larger in the class, in captures by more than
// their spread, and in single answers by a good part of that. NaN if there is none.
struct Kept {
  double own = NAN, other = NAN;

  double weaker() const;
  double both() const;  // 1: both are above half
};
// Shapes: folds [folds]; returns [answers].
std::vector<Kept> MeasureKept(const std::vector<MixedAnswer>& answers,
                              const std::vector<ClassGeometry>& folds);

// Answers to all leaders with the same weights, under the name that tables show.
using MixVariant = std::pair<std::string, std::vector<MixedAnswer>>;

// The figures of every variant with their intervals, and those of each pair of classes.
std::vector<report::Table> MixTables(const std::string& title,
                                     const std::vector<std::string>& classes,
                                     const std::vector<ClassGeometry>& folds,
                                     const std::vector<MixVariant>& variants);

// An answer to the leader's own class with another one at -1, beside the own class by itself.
struct AvoidingAnswer {
  int leader = 0;
  int own = 0, avoided = 0;
  std::vector<float> alone, avoiding;  // the judge's probabilities [classes]
  double moved = 0;                    // change of the mean distance of the roots, metres
};
// The figures of all answers with their intervals.
report::Table AvoidTable(const std::string& title, const std::vector<AvoidingAnswer>& answers);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_MIXES_H_
