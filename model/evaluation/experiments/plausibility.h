#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_PLAUSIBILITY_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_PLAUSIBILITY_H_

#include <string>
#include <vector>

#include "model/body/contact.h"
#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::evaluation::experiments {

// A figure of a pair, and how those of several pairs are combined.
struct PairFigure {
  std::string name;
  bool largest = false;  // the largest of all pairs; otherwise their mean
};

// What a viewer would notice in one pair.
struct PairFigures {
  std::vector<double> values;  // like Plausibility::Figures; NaN where there is nothing to measure
  std::vector<double> faults;  // how much is wrong in each frame, about 1 for one obvious fault
};

// How the two people of a class meet.
struct ClassContacts {
  bool hands_meet = false;  // hands that stay apart although one is offered are a fault
};

// Measures pairs of people with one skeleton. Metres, y up.
//
// Cost:    linear in the frames.
// Threads: const methods are safe to call concurrently.
class Plausibility {
 public:
  // Requires a skeleton that Validate accepts.
  explicit Plausibility(const motion::Skeleton& skeleton);

  // Whether the skeleton has the joints that the figures need.
  bool possible() const;

  static std::vector<PairFigure> Figures();
  // Explains the figures, for the notes of a table.
  static std::vector<std::string> Notes();

  // Requires possible() and at least one frame. Shapes: leader like the follower.
  PairFigures Measure(const motion::Poses& leader, const motion::Poses& follower, double rate,
                      const ClassContacts& contacts) const;

 private:
  motion::Skeleton skeleton_;
  body::Body body_;
};

// Combines the figures of pairs. Requires at least one pair. Shapes: as Plausibility::Figures.
std::vector<double> Combine(const std::vector<PairFigures>& pairs);

// The first frame of the `length` consecutive frames with the most faults, and their sum.
struct WorstPart {
  int first = 0;
  double faults = 0;
};
WorstPart FindWorstPart(const std::vector<double>& faults, int length);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_PLAUSIBILITY_H_
