#ifndef DUET_MODEL_CLEANUP_CLEAN_UP_H_
#define DUET_MODEL_CLEANUP_CLEAN_UP_H_

#include <vector>

#include "model/cleanup/capsules.h"
#include "model/cleanup/contacts.h"
#include "model/cleanup/floor.h"
#include "model/cleanup/joint_ranges.h"
#include "model/cleanup/limbs.h"
#include "model/cleanup/spacing.h"
#include "model/cleanup/timing.h"
#include "model/cleanup/upright.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// What a body can do and a network need not know: stands upright, on the floor and near the other,
// on feet that do not slide, bends as joints do, and passes through nobody. World metres, y up.
namespace duet::cleanup {

struct Options {
  UprightOptions upright;
  SpacingOptions spacing;
  CapsuleOptions capsules;
  JointRangeOptions joint_ranges;
  FloorOptions floor;
  ContactOptions contacts;
};

// Corrects one window of a follower, stage by stage. Every stage leaves the settled frames as they
// are, eases in after them, and keeps the bones' lengths.
//
// Cost:    linear in the frames.
// Threads: const methods are safe to call concurrently.
class CleanUp {
 public:
  // Requires a skeleton that Validate accepts.
  explicit CleanUp(const motion::Skeleton& skeleton, const Options& options = {});

  // Shapes: leader as the follower; touch [frames]. At least one frame. The leader's feet tell
  // where the floor is.
  void Apply(const motion::Poses& leader, const Touch& touch, const Timing& timing,
             motion::Poses* follower) const;

 private:
  motion::Skeleton skeleton_;
  Options options_;
  Body body_;
  std::vector<double> radii_;
};

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_CLEAN_UP_H_
