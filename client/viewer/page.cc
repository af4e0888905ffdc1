#include "client/viewer/page.h"

#include <algorithm>

#include "absl/strings/escaping.h"
#include "client/viewer/page_parts.h"
#include "nlohmann/json.hpp"

// Embedded by duet_embed_file.
extern "C" {
extern const char duet_page[], duet_page_end[];
extern const char duet_page_style[], duet_page_style_end[];
extern const char duet_page_script[], duet_page_script_end[];
}

namespace duet::client::viewer {
namespace {

// All classes in the keyframes, in the order of their first occurrence.
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

// One weight per class. A class that a keyframe omits has weight 0, as on the server.
nlohmann::json WeightsJson(const WeightKeyframe& keyframe,
                           const std::vector<std::string>& classes) {
  std::vector<float> values(classes.size(), 0.0f);
  for (const ClassWeight& weight : keyframe.weights) {
    const auto found = std::find(classes.begin(), classes.end(), weight.interaction_class);
    values[static_cast<size_t>(found - classes.begin())] = weight.weight;
  }
  return {{"frame", keyframe.frame}, {"weights", values}};
}

nlohmann::json GradeJson(const MotionGrade& grade) {
  nlohmann::json runs = nlohmann::json::array();
  for (const FrameRun& run : grade.bad_runs) runs.push_back({run.first_frame, run.frame_count});
  return {{"twisted", grade.twisted},
          {"skating", grade.skating},
          {"leaderSkating", grade.leader_skating},
          {"overlapping", grade.overlapping},
          {"badRuns", runs}};
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
  nlohmann::json data = {{"title", content.title},
                         {"subtitle", content.subtitle},
                         {"joints", leader.joint_names},
                         {"bones", bones},
                         {"frameRate", leader.frame_rate_hz},
                         {"frames", leader.frame_count()},
                         {"classes", classes},
                         {"keyframes", keyframes},
                         {"leader", EncodePositions(leader)},
                         {"follower", EncodePositions(content.pair.follower)}};
  if (!content.glb.empty()) data["glb"] = absl::Base64Escape(content.glb);
  if (content.grade) data["grade"] = GradeJson(*content.grade);
  return SafeJson(data);
}

absl::StatusOr<std::string> RenderPage(const PageContent& content) {
  const motion::Clip& leader = content.pair.leader;
  absl::Status status = CheckMotion("pair", leader.joint_names, leader, &content.pair.follower);
  if (status.ok()) status = CheckBones(content.bones, leader.joint_count());
  if (!status.ok()) return status;
  return FillPage({Embedded(duet_page, duet_page_end), content.title,
                   Embedded(duet_page_style, duet_page_style_end), PageDataJson(content),
                   Embedded(duet_page_script, duet_page_script_end)});
}

}  // namespace duet::client::viewer
