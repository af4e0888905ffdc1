#ifndef DUET_CLIENT_VIEWER_PAGE_PARTS_H_
#define DUET_CLIENT_VIEWER_PAGE_PARTS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json_fwd.hpp"

// The parts that both pages share.

namespace duet::client::viewer {

// The parts in which the pages differ: values of the placeholders of page/frame.html. `body` may
// contain the shared controls "{{VIEWS}}", "{{PLAY}}" and "{{SPEEDS}}".
struct PageParts {
  absl::string_view body;
  std::string title;
  absl::string_view style;
  std::string data;  // JSON of SafeJson
  absl::string_view script;
};
std::string FillPage(const PageParts& parts);

// Returns the text of an embedded file.
inline absl::string_view Embedded(const char* begin, const char* end) {
  return {begin, static_cast<size_t>(end - begin)};
}

// Serialises `data` as JSON that is safe inside <script> for any names.
std::string SafeJson(const nlohmann::json& data);

// Encodes positions [frames, joints, 3] as base64 of little-endian float32.
std::string EncodePositions(const motion::Clip& clip);

// INVALID_ARGUMENT, with `name` in front, unless leader and follower have at least one frame, a
// rate above 0, these joints, finite positions, and the same frames and rate. `follower` may be
// null.
absl::Status CheckMotion(const std::string& name, const std::vector<std::string>& joint_names,
                         const motion::Clip& leader, const motion::Clip* follower);
// INVALID_ARGUMENT if a bone names a joint outside of [0, joint_count).
absl::Status CheckBones(const std::vector<motion::Bone>& bones, int joint_count);

}  // namespace duet::client::viewer

#endif  // DUET_CLIENT_VIEWER_PAGE_PARTS_H_
