#ifndef DUET_CLIENT_VIEWER_GALLERY_H_
#define DUET_CLIENT_VIEWER_GALLERY_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::viewer {

// One motion of a gallery: a leader and a follower, or one person.
struct GalleryMotion {
  std::string name;
  motion::Clip leader;
  std::optional<motion::Clip> follower;  // the leader's joints, frames and rate
};

struct GalleryContent {
  std::vector<GalleryMotion> motions;  // the same joints; rates and lengths may differ
  std::vector<motion::Bone> bones;
  std::string title;
  std::string subtitle;
};

// Returns a self-contained HTML page that plays motions side by side, synchronised and from the
// same camera, with curves of speed and distance below the timeline.
//
// Errors: INVALID_ARGUMENT that names the motion if there are no motions or more than kMostMotions,
//         joints differ from the first motion's, a motion has no frame or no valid rate, leader and
//         follower differ in frames or rate, a position is not finite, or a bone names an unknown
//         joint.
inline constexpr int kMostMotions = 12;
absl::StatusOr<std::string> RenderGallery(const GalleryContent& content);

}  // namespace duet::client::viewer

#endif  // DUET_CLIENT_VIEWER_GALLERY_H_
