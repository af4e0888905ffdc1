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
  // A foot comes to stand below the first speed and height above the floor, and stands on up to the
  // second.
  double slow_metres_per_second = 0.3, fast_metres_per_second = 0.6;
  double low_metres = 0.08, high_metres = 0.12;
  double shortest_seconds = 0.2;
  // A foot that would have to be held farther from where it is goes on to another place.
  double farthest_metres = 0.06;
  double ease_seconds = 0.2;  // into a contact and out of it
};

// Frames [begin, end) in which a foot stands at a place.
struct Contact {
  int begin = 0;
  int end = 0;
  motion::Vec3 place;
};

// Of one foot's positions, from the last settled frame on; a foot that stands there stays where
// that frame has it. Shapes: foot [frames].
std::vector<Contact> FindContacts(const std::vector<motion::Vec3>& foot, float floor,
                                  const ContactOptions& options, const Timing& timing);

// Holds each foot in place along the floor while it stands, by turning thigh and shin. The body
// goes along with its feet, so that it does not lean for them. A skeleton without legs of two bones
// stays as it is.
void HoldContacts(const motion::Skeleton& skeleton, const Body& body, float floor,
                  const ContactOptions& options, const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_CONTACTS_H_
