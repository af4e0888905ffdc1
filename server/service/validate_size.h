#ifndef DUET_SERVER_SERVICE_VALIDATE_SIZE_H_
#define DUET_SERVER_SERVICE_VALIDATE_SIZE_H_

#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"
#include "server/service/violations.h"

namespace duet::server::service {

// Adds a violation under `field` if the poses, in metres, are far larger or smaller than a person:
// positions in another unit than the declared one. Single lost joints and frames do not matter: a
// tracker that has lost the person reports most joints in one place, even in most of the frames.
// But in some frame, some joint must be elsewhere. Accepts poses without frames.
void ValidateSize(absl::string_view field, const motion::Poses& poses, Violations& violations);

// Whether all joints of a pose are in one place: a tracker has lost the person.
bool IsPoint(absl::Span<const motion::Vec3> pose);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_SIZE_H_
