#ifndef DUET_MODEL_CLEANUP_CONTACTS_H_
#define DUET_MODEL_CLEANUP_CONTACTS_H_

#include <vector>

#include "model/cleanup/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

struct ContactOptions {
  bool enabled = true;
  // A contact begins when speed and height above the floor fall below the first value, and ends
  // when one exceeds the second.
  double slow_metres_per_second = 0.3, fast_metres_per_second = 0.6;
  double low_metres = 0.08, high_metres = 0.12;
  double shortest_seconds = 0.2;
  // Maximum correction. A foot that would have to move farther gets a new contact.
  double farthest_metres = 0.06;
  double ease_seconds = 0.2;  // at the beginning and the end of a contact
};

// Frames [begin, end) in which a foot stands at one position.
struct Contact {
  int begin = 0;
  int end = 0;
  motion::Vec3 place;
};

// Finds the contacts of one foot from the last settled frame on. A contact in the last settled
// frame keeps the position of that frame. Shapes: foot [frames].
std::vector<Contact> FindContacts(const std::vector<motion::Vec3>& foot, float floor,
                                  const ContactOptions& options, const Timing& timing);

// Fixes the horizontal position of each foot during its contacts by rotating thigh and shin. The
// body moves with its feet, so that it does not start to lean. Does nothing for a skeleton without
// legs of two bones.
void HoldContacts(const motion::Skeleton& skeleton, const Body& body, float floor,
                  const ContactOptions& options, const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_CONTACTS_H_
