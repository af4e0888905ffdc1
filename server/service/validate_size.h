#ifndef DUET_SERVER_SERVICE_VALIDATE_SIZE_H_
#define DUET_SERVER_SERVICE_VALIDATE_SIZE_H_

#include "absl/strings/string_view.h"
#include "model/motion/poses.h"
#include "server/service/violations.h"

namespace duet::server::service {

// Adds a violation under `field` if the poses, in metres, are far larger or smaller than a person:
// positions in another unit than the declared one. Single lost joints and frames do not matter: a
// tracker that has lost the person reports most joints in one place, even in most of the frames.
// But in some frame, some joint must be elsewhere. Accepts poses without frames.
void ValidateSize(absl::string_view field, const motion::Poses& poses, Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_SIZE_H_
