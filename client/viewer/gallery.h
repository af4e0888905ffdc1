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

// A line of figures beside the motions; texts as they are shown.
struct GalleryFigure {
  std::string group;
  std::string title;
  std::vector<std::string> values;  // one for each of the value_titles, or one of all together
};

struct GalleryContent {
  std::vector<GalleryMotion> motions;  // joints alike; rates and lengths may differ
  std::vector<motion::Bone> bones;
  std::string title;
  std::string subtitle;
  std::vector<std::string> value_titles;  // heads of the figures' columns; may be empty
  std::vector<GalleryFigure> figures;     // may be empty
};

// A self-contained HTML page that plays motions side by side, all at the same moment and seen from
// the same place, with curves of speed and distance below the time line.
//
// Errors: INVALID_ARGUMENT naming the motion: none at all, more than kMostMotions, joints other
//         than the first one's, no frame, a rate that is none, two people who do not fit together,
//         a position that is not finite; a bone without such a joint.
inline constexpr int kMostMotions = 12;
absl::StatusOr<std::string> RenderGallery(const GalleryContent& content);

}  // namespace duet::client::viewer

#endif  // DUET_CLIENT_VIEWER_GALLERY_H_
