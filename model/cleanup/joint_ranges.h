#ifndef DUET_MODEL_CLEANUP_JOINT_RANGES_H_
#define DUET_MODEL_CLEANUP_JOINT_RANGES_H_

#include <optional>

#include "model/cleanup/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// An angle up to the first is left alone; none goes beyond the second. Degrees.
struct SoftRange {
  double free = 0;
  double most = 0;
};

// What grown people can do without help, mean and standard deviation in degrees: knees bend by
// 142.5 (5.4), elbows by 142.9 (5.6) and backwards by 0.6 (3.1); hips turn the leg about itself by
// 47 (6) either way, shoulders the arm by 69 (5) inwards and 104 (9) outwards (Boone and Azen 1979,
// Journal of Bone and Joint Surgery 61-A, 756-759). Knees bend backwards by up to 10 (American
// Academy of Orthopaedic Surgeons, Joint Motion, 1965). Necks bend forwards by 54 (9), to the side
// by 45 (7), backwards by 77 (13) (Youdas and others 1992, Physical Therapy 72, 770-780, people in
// their twenties).
struct JointRangeOptions {
  bool enabled = true;
  SoftRange folded = {143, 155};   // knees and elbows: up to two deviations more than the mean
  SoftRange backwards = {5, 10};   // the same
  SoftRange knee_aside = {5, 10};  // out of the plane that the leg may bend in
  // How far from straight backwards a knee may point the shin, from straight forwards an elbow the
  // forearm, as seen along thigh or upper arm: two deviations and what the reference may be off.
  double leg_turn = 60;
  double arm_turn = 110;
  SoftRange neck = {60, 85};  // between the trunk and the way from neck to head
};

// Keeps knees and elbows from bending backwards, sideways or flat, and the head from falling off
// the neck, softly and each frame by itself: joints move without jumps where the body does. A limb
// that is corrected keeps the direction from hip to foot or shoulder to hand. A skeleton without
// hips, chest, limbs or head loses what needs them; a limb that is raised against its trunk's
// direction, where that tells nothing of it, is left as it is.
//
// A leg that is made straight reaches farther. `floor`, where there is one, is its height in
// metres: no foot is brought more than 3 cm below it, the leg keeps what is wrong with it instead.
void KeepJointRanges(const motion::Skeleton& skeleton, const Body& body, std::optional<float> floor,
                     const JointRangeOptions& options, const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_JOINT_RANGES_H_
