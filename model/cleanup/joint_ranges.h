#ifndef DUET_MODEL_CLEANUP_JOINT_RANGES_H_
#define DUET_MODEL_CLEANUP_JOINT_RANGES_H_

#include <optional>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// Active ranges of motion of adults, as mean (standard deviation) in degrees: knee flexion 142.5
// (5.4), elbow flexion 142.9 (5.6), elbow hyperextension 0.6 (3.1), hip rotation 47 (6) in both
// directions, shoulder rotation 69 (5) inwards and 104 (9) outwards (Boone and Azen 1979, Journal
// of Bone and Joint Surgery 61-A, 756-759). Knee hyperextension up to 10 (American Academy of
// Orthopaedic Surgeons, Joint Motion, 1965). Neck flexion 54 (9), to the side 45 (7), extension 77
// (13) (Youdas and others 1992, Physical Therapy 72, 770-780, people aged 20 to 29).
struct JointRangeOptions {
  bool enabled = true;
  SoftRange folded = {143, 155};   // flexion of knees and elbows: mean to two deviations above
  SoftRange backwards = {5, 10};   // hyperextension of knees and elbows
  SoftRange knee_aside = {5, 10};  // out of the plane in which the leg may bend
  // Maximum angle, seen along thigh or upper arm, of the shin from straight backwards and of the
  // forearm from straight forwards: two deviations plus the uncertainty of the reference.
  double leg_turn = 60;
  double arm_turn = 110;
  SoftRange neck = {60, 85};  // between the trunk and the direction from neck to head
};

// Limits how far knees and elbows bend backwards, sideways or together, and how far the head bends
// from the trunk. The limits are soft and apply to each frame independently, so continuous motion
// stays continuous. A corrected limb keeps the direction from hip to foot or from shoulder to hand.
// Corrections that need hips, chest, limbs or a head are skipped if the skeleton lacks them. A limb
// that is raised along its trunk's direction is not corrected, because the trunk then gives no
// reference.
//
// Straightening a leg lengthens its reach. `floor`: height in metres, if there is a floor. A
// correction that would move a foot more than 3 cm below it is reduced.
void KeepJointRanges(const motion::Skeleton& skeleton, const body::Body& body,
                     std::optional<float> floor, const JointRangeOptions& options,
                     const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_JOINT_RANGES_H_
