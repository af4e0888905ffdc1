#ifndef DUET_MODEL_CLEANUP_CONTACTS_H_
#define DUET_MODEL_CLEANUP_CONTACTS_H_

#include <vector>

#include "model/motion/vec3.h"

namespace duet::cleanup {

struct ContactOptions {
  // A contact begins when speed and height above the floor fall below the first value, and ends
  // when one exceeds the second.
  double slow_metres_per_second = 0.3, fast_metres_per_second = 0.6;
  double low_metres = 0.08, high_metres = 0.12;
  double shortest_seconds = 0.2;
  // How far a foot moves within a contact at most.
  double farthest_metres = 0.06;
};

// Frames [begin, end) in which a foot stands at one position.
struct Contact {
  int begin = 0;
  int end = 0;
  motion::Vec3 place;
};

// Finds where a captured foot stands. Shapes: foot [frames].
std::vector<Contact> FindContacts(const std::vector<motion::Vec3>& foot, float floor,
                                  double frame_rate_hz, const ContactOptions& options = {});

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_CONTACTS_H_
