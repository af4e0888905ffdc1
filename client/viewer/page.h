#ifndef DUET_CLIENT_VIEWER_PAGE_H_
#define DUET_CLIENT_VIEWER_PAGE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/request.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::viewer {

// What a page shows.
struct PageContent {
  motion::ClipPair pair;  // same joints, rate and frames; metres, y up
  std::vector<motion::Bone> bones;
  std::string title;
  std::string subtitle;
  // Class weights over time; one keyframe for weights that never change, none to show no weights.
  std::vector<WeightKeyframe> weights;
  // The same as a binary glTF file, for the page to hand out; empty for none.
  std::string glb;
};

// A self-contained HTML page that plays both characters in three dimensions: nothing is fetched,
// and it works from a file. About 0.9 MB, of which three.js is most.
//
// Errors: INVALID_ARGUMENT when the two characters do not fit together, a bone has no such joint,
//         there is no frame, or a position is not finite.
absl::StatusOr<std::string> RenderPage(const PageContent& content);

}  // namespace duet::client::viewer

#endif  // DUET_CLIENT_VIEWER_PAGE_H_
