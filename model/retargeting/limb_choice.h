#ifndef DUET_MODEL_RETARGETING_LIMB_CHOICE_H_
#define DUET_MODEL_RETARGETING_LIMB_CHOICE_H_

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "model/retargeting/joint_tree.h"

namespace duet::retargeting {

// Several joints of a file may have the name of one joint of the body: helpers (`__UpLeg_L` above
// `UpLeg_L`), targets of inverse kinematics, copies. These are all of them, from hip or shoulder to
// foot or hand.
using LimbCandidates = std::array<std::vector<int>, 3>;

// Chooses the joints that make a limb of a person: each below the one before it, with the fewest
// bones between them, an upper and a lower bone of similar length, and no name that begins with
// '_'. Of equal ones, the first in the file.
//
// `tree` is null for a file without a hierarchy; `distance` gives the distance of two joints.
// Requires a candidate for each joint.
std::array<int, 3> ChooseLimb(const LimbCandidates& candidates,
                              const std::vector<std::string>& names, const JointTree* tree,
                              const std::function<double(int, int)>& distance);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_LIMB_CHOICE_H_
