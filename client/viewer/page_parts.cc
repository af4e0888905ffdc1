#include "client/viewer/page_parts.h"

#include <cstdint>
#include <cstring>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "nlohmann/json.hpp"

// Embedded by duet_embed_file.
extern "C" {
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

std::string EscapeHtml(absl::string_view text) {
  return absl::StrReplaceAll(text,
                             {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

void AppendLittleEndian(float value, std::string* bytes) {
  uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 0; shift < 32; shift += 8) bytes->push_back(static_cast<char>(bits >> shift));
}

absl::Status CheckPerson(const std::string& name, const motion::Clip& clip,
                         const std::vector<std::string>& joint_names) {
  if (clip.frame_count() < 1 || !(clip.frame_rate_hz > 0)) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": expected at least one frame and a rate above 0, got ",
                     clip.frame_count(), " frames at ", clip.frame_rate_hz, " Hz"));
  }
  if (clip.joint_names != joint_names || clip.poses.joint_count() != clip.joint_count()) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": expected the joints of the first motion, got others"));
  }
  for (const motion::Vec3& position : clip.poses.all()) {
    if (IsFinite(position)) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": expected finite positions, got one that is not"));
  }
  return absl::OkStatus();
}

}  // namespace

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

std::string SafeJson(const nlohmann::json& data) {
  // "</script>" inside a string would end the script. In JSON, "<" occurs only inside strings,
  // where it can be escaped.
  return absl::StrReplaceAll(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
                             {{"<", "\\u003c"}});
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

absl::Status CheckMotion(const std::string& name, const std::vector<std::string>& joint_names,
                         const motion::Clip& leader, const motion::Clip* follower) {
  absl::Status status = CheckPerson(name, leader, joint_names);
  if (!status.ok() || follower == nullptr) return status;
  status = CheckPerson(name, *follower, joint_names);
  if (!status.ok()) return status;
  if (follower->frame_count() == leader.frame_count() &&
      follower->frame_rate_hz == leader.frame_rate_hz) {
    return status;
  }
  return absl::InvalidArgumentError(
      absl::StrCat(name, ": expected equal frames and rates of leader and follower"));
}

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

}  // namespace duet::client::viewer
