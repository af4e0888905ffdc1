#include "client/viewer/page.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "model/motion/recorded_motion.h"
#include "nlohmann/json.hpp"

// Embedded by duet_embed_file.
extern "C" {
extern const char duet_page[], duet_page_end[];
extern const char duet_page_style[], duet_page_style_end[];
extern const char duet_page_script[], duet_page_script_end[];
extern const char duet_gallery[], duet_gallery_end[];
extern const char duet_gallery_style[], duet_gallery_style_end[];
extern const char duet_gallery_script[], duet_gallery_script_end[];
extern const char duet_frame[], duet_frame_end[];
extern const char duet_frame_views[], duet_frame_views_end[];
extern const char duet_frame_play[], duet_frame_play_end[];
extern const char duet_frame_speeds[], duet_frame_speeds_end[];
extern const char duet_frame_licence[], duet_frame_licence_end[];
extern const char duet_three[], duet_three_end[];
extern const char duet_three_controls[], duet_three_controls_end[];
}

namespace duet::client::viewer {
namespace {

// The parts in which the pages differ: values of the placeholders of page/frame.html. `body` may
// contain the shared controls "{{VIEWS}}", "{{PLAY}}" and "{{SPEEDS}}".
struct PageParts {
  absl::string_view body;
  std::string title;
  absl::string_view style;
  std::string data;  // JSON of SafeJson
  absl::string_view script;
};

// Returns the text of an embedded file.
inline absl::string_view Embedded(const char* begin, const char* end) {
  return {begin, static_cast<size_t>(end - begin)};
}

std::string EscapeHtml(absl::string_view text) {
  return absl::StrReplaceAll(text,
                             {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

std::string FillPage(const PageParts& parts) {
  const std::string page =
      absl::StrReplaceAll(Embedded(duet_frame, duet_frame_end), {{"{{BODY}}", parts.body}});
  // One pass: inserted text is not searched again, so a title that contains "{{DATA}}" is harmless.
  return absl::StrReplaceAll(
      page, {{"{{TITLE}}", EscapeHtml(parts.title)},
             {"{{VIEWS}}", Embedded(duet_frame_views, duet_frame_views_end)},
             {"{{PLAY}}", Embedded(duet_frame_play, duet_frame_play_end)},
             {"{{SPEEDS}}", Embedded(duet_frame_speeds, duet_frame_speeds_end)},
             {"{{STYLE}}", parts.style},
             {"{{DATA}}", parts.data},
             {"{{LICENCE}}", Embedded(duet_frame_licence, duet_frame_licence_end)},
             {"{{THREE}}", Embedded(duet_three, duet_three_end)},
             {"{{CONTROLS}}", Embedded(duet_three_controls, duet_three_controls_end)},
             {"{{SCRIPT}}", parts.script}});
}

// Serialises `data` as JSON that is safe inside <script> for any names.
std::string SafeJson(const nlohmann::json& data) {
  // "</script>" inside a string would end the script. In JSON, "<" occurs only inside strings,
  // where it can be escaped.
  return absl::StrReplaceAll(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
                             {{"<", "\\u003c"}});
}

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "positions are copied as they are");

// Encodes positions [frames, joints, 3] as base64 of little-endian float32.
std::string EncodePositions(const motion::Clip& clip) {
  const absl::Span<const motion::Vec3> all = clip.poses.all();
  return absl::Base64Escape(
      {reinterpret_cast<const char*>(all.data()), all.size() * sizeof(motion::Vec3)});
}

// INVALID_ARGUMENT, with `name` in front, unless leader and follower are valid clips of these
// joints with the same frames and rate. `follower` may be null.
absl::Status CheckMotion(const std::string& name, const std::vector<std::string>& joint_names,
                         const motion::Clip& leader, const motion::Clip* follower) {
  for (const motion::Clip* person : {&leader, follower}) {
    if (person == nullptr) continue;
    absl::Status status = CheckClip(name, *person);
    if (!status.ok()) return status;
    if (person->joint_names != joint_names) {
      return absl::InvalidArgumentError(
          absl::StrCat(name, ": expected the joints of the first motion, got others"));
    }
    if (person->frame_count() != leader.frame_count() ||
        person->frame_rate_hz != leader.frame_rate_hz) {
      return absl::InvalidArgumentError(
          absl::StrCat(name, ": expected equal frames and rates of leader and follower"));
    }
  }
  return absl::OkStatus();
}

// INVALID_ARGUMENT if a bone names a joint outside of [0, joint_count).
absl::Status CheckBones(const std::vector<motion::Bone>& bones, int joint_count) {
  for (const motion::Bone& bone : bones) {
    for (const int joint : {bone.parent, bone.child}) {
      if (joint >= 0 && joint < joint_count) continue;
      return absl::InvalidArgumentError(
          absl::StrCat("bones: expected joints 0 to ", joint_count - 1, ", got ", joint));
    }
  }
  return absl::OkStatus();
}

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

absl::Status Check(const GalleryContent& content) {
  if (content.motions.empty() || content.motions.size() > kMostMotions) {
    return absl::InvalidArgumentError(
        absl::StrCat("motions: expected 1 to ", kMostMotions, ", got ", content.motions.size()));
  }
  const motion::Clip& first = content.motions[0].leader;
  for (const GalleryMotion& motion : content.motions) {
    absl::Status status = CheckMotion(motion.name, first.joint_names, motion.leader,
                                      motion.follower ? &*motion.follower : nullptr);
    if (!status.ok()) return status;
  }
  return CheckBones(content.bones, first.joint_count());
}

// {frameRate, frames, leader, follower?}
nlohmann::json MotionJson(const motion::Clip& leader, const motion::Clip* follower) {
  nlohmann::json motion = {{"frameRate", leader.frame_rate_hz},
                           {"frames", leader.frame_count()},
                           {"leader", EncodePositions(leader)}};
  if (follower != nullptr) motion["follower"] = EncodePositions(*follower);
  return motion;
}

// Adds the fields of both pages: {title, subtitle, joints, bones}.
template <typename Content>
void AddFrame(const Content& content, const std::vector<std::string>& joints,
              nlohmann::json* data) {
  (*data)["title"] = content.title;
  (*data)["subtitle"] = content.subtitle;
  (*data)["joints"] = joints;
  (*data)["bones"] = nlohmann::json::array();
  for (const motion::Bone& bone : content.bones) {
    (*data)["bones"].push_back({bone.parent, bone.child});
  }
}

// {title, subtitle, joints, bones, motions [{name, frameRate, frames, leader, follower?}]}
nlohmann::json Data(const GalleryContent& content) {
  nlohmann::json data;
  AddFrame(content, content.motions[0].leader.joint_names, &data);
  for (const GalleryMotion& motion : content.motions) {
    data["motions"].push_back(
        MotionJson(motion.leader, motion.follower ? &*motion.follower : nullptr));
    data["motions"].back()["name"] = motion.name;
  }
  return data;
}

}  // namespace

std::string PageDataJson(const PageContent& content) {
  nlohmann::json data = MotionJson(content.pair.leader, &content.pair.follower);
  AddFrame(content, content.pair.leader.joint_names, &data);
  const std::vector<std::string> classes = Classes(content.weights);
  data["classes"] = classes;
  data["keyframes"] = nlohmann::json::array();
  for (const WeightKeyframe& keyframe : content.weights) {
    data["keyframes"].push_back(WeightsJson(keyframe, classes));
  }
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

absl::StatusOr<std::string> RenderGallery(const GalleryContent& content) {
  absl::Status status = Check(content);
  if (!status.ok()) return status;
  return FillPage({Embedded(duet_gallery, duet_gallery_end), content.title,
                   Embedded(duet_gallery_style, duet_gallery_style_end), SafeJson(Data(content)),
                   Embedded(duet_gallery_script, duet_gallery_script_end)});
}

}  // namespace duet::client::viewer
