#ifndef DUET_CLIENT_VIEWER_PAGE_H_
#define DUET_CLIENT_VIEWER_PAGE_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/request.h"
#include "client/result.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::viewer {

// The content of a page.
struct PageContent {
  motion::ClipPair pair;  // same joints, rate and frames; metres, y up
  std::vector<motion::Bone> bones;
  std::string title;
  std::string subtitle;
  // Class weights over time; one keyframe for constant weights, none to hide the weights.
  std::vector<WeightKeyframe> weights;
  // The pair as a binary glTF file that the page offers for download; empty for none.
  std::string glb;
  // The grade that the page shows and whose bad frames it marks on the time line.
  std::optional<MotionGrade> grade;
};

// Returns a self-contained HTML page that plays both characters in 3D. It fetches nothing and works
// from a file. Its size is about 0.9 MB, mostly three.js, plus `glb` as base64.
//
// Errors: INVALID_ARGUMENT if leader and follower differ in joints, frames or rate, a bone names an
//         unknown joint, there is no frame, or a position is not finite.
absl::StatusOr<std::string> RenderPage(const PageContent& content);

// Returns the page's data as JSON that is safe inside <script> for any names:
//   {title, subtitle, joints [J], bones [[parent, child]], frameRate, frames, classes [C],
//    keyframes [{frame, weights [C]}], leader, follower, glb?,
//    grade? {twisted, skating, leaderSkating, overlapping, badRuns [[first frame, frames]]}}
// with positions [frames, J, 3] as base64 of little-endian float32.
std::string PageDataJson(const PageContent& content);

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
// same camera.
//
// Errors: INVALID_ARGUMENT that names the motion if there are no motions or more than kMostMotions,
//         joints differ from the first motion's, a motion is no valid clip (motion::CheckClip),
//         leader and follower differ in frames or rate, or a bone names an unknown joint.
inline constexpr int kMostMotions = 12;
absl::StatusOr<std::string> RenderGallery(const GalleryContent& content);

}  // namespace duet::client::viewer

#endif  // DUET_CLIENT_VIEWER_PAGE_H_
