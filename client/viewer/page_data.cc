#include "client/viewer/page_data.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "absl/strings/escaping.h"
#include "absl/strings/str_replace.h"
#include "nlohmann/json.hpp"

namespace duet::client::viewer {
namespace {

void AppendLittleEndian(float value, std::string* bytes) {
  uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 0; shift < 32; shift += 8) bytes->push_back(static_cast<char>(bits >> shift));
}

std::string EncodePositions(const motion::Clip& clip) {
  std::string bytes;
  bytes.reserve(clip.poses.all().size() * sizeof(motion::Vec3));
  for (const motion::Vec3& position : clip.poses.all()) {
    AppendLittleEndian(position.x, &bytes);
    AppendLittleEndian(position.y, &bytes);
    AppendLittleEndian(position.z, &bytes);
  }
  return absl::Base64Escape(bytes);
}

// Every class that any keyframe names, in the order of first mention.
std::vector<std::string> Classes(const std::vector<WeightKeyframe>& keyframes) {
  std::vector<std::string> classes;
  for (const WeightKeyframe& keyframe : keyframes) {
    for (const ClassWeight& weight : keyframe.weights) {
      if (std::find(classes.begin(), classes.end(), weight.interaction_class) == classes.end()) {
        classes.push_back(weight.interaction_class);
      }
    }
  }
  return classes;
}

// One weight for each class; a class that a keyframe leaves out weighs 0, as on the server.
nlohmann::json WeightsJson(const WeightKeyframe& keyframe,
                           const std::vector<std::string>& classes) {
  std::vector<float> values(classes.size(), 0.0f);
  for (const ClassWeight& weight : keyframe.weights) {
    const auto found = std::find(classes.begin(), classes.end(), weight.interaction_class);
    values[static_cast<size_t>(found - classes.begin())] = weight.weight;
  }
  return {{"frame", keyframe.frame}, {"weights", values}};
}

}  // namespace

std::string PageDataJson(const PageContent& content) {
  const motion::Clip& leader = content.pair.leader;
  const std::vector<std::string> classes = Classes(content.weights);
  nlohmann::json bones = nlohmann::json::array();
  for (const motion::Bone& bone : content.bones) bones.push_back({bone.parent, bone.child});
  nlohmann::json keyframes = nlohmann::json::array();
  for (const WeightKeyframe& keyframe : content.weights) {
    keyframes.push_back(WeightsJson(keyframe, classes));
  }
  const nlohmann::json data = {{"title", content.title},
                               {"subtitle", content.subtitle},
                               {"joints", leader.joint_names},
                               {"bones", bones},
                               {"frameRate", leader.frame_rate_hz},
                               {"frames", leader.frame_count()},
                               {"classes", classes},
                               {"keyframes", keyframes},
                               {"leader", EncodePositions(leader)},
                               {"follower", EncodePositions(content.pair.follower)}};
  // "</script>" inside a string would end the script. In JSON "<" stands inside strings alone,
  // where it may be written as an escape.
  return absl::StrReplaceAll(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
                             {{"<", "\\u003c"}});
}

}  // namespace duet::client::viewer
