#include "client/viewer/gallery.h"

#include "absl/strings/str_cat.h"
#include "client/viewer/page_parts.h"
#include "nlohmann/json.hpp"

extern "C" {
extern const char duet_gallery[], duet_gallery_end[];
extern const char duet_gallery_style[], duet_gallery_style_end[];
extern const char duet_gallery_script[], duet_gallery_script_end[];
}

namespace duet::client::viewer {
namespace {

using nlohmann::json;

absl::Status CheckPerson(const std::string& name, const motion::Clip& clip,
                         const motion::Clip& first) {
  if (clip.frame_count() < 1 || !(clip.frame_rate_hz > 0)) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": expected at least one frame and a rate above 0, got ",
                     clip.frame_count(), " frames at ", clip.frame_rate_hz, " Hz"));
  }
  if (clip.joint_names != first.joint_names || clip.poses.joint_count() != clip.joint_count()) {
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

absl::Status CheckMotion(const GalleryMotion& motion, const motion::Clip& first) {
  absl::Status status = CheckPerson(motion.name, motion.leader, first);
  if (!status.ok() || !motion.follower) return status;
  status = CheckPerson(motion.name, *motion.follower, first);
  if (!status.ok()) return status;
  if (motion.follower->frame_count() == motion.leader.frame_count() &&
      motion.follower->frame_rate_hz == motion.leader.frame_rate_hz) {
    return status;
  }
  return absl::InvalidArgumentError(
      absl::StrCat(motion.name, ": expected equal frames and rates of leader and follower"));
}

absl::Status Check(const GalleryContent& content) {
  if (content.motions.empty() || content.motions.size() > kMostMotions) {
    return absl::InvalidArgumentError(
        absl::StrCat("motions: expected 1 to ", kMostMotions, ", got ", content.motions.size()));
  }
  const motion::Clip& first = content.motions[0].leader;
  for (const GalleryMotion& motion : content.motions) {
    absl::Status status = CheckMotion(motion, first);
    if (!status.ok()) return status;
  }
  for (const motion::Bone& bone : content.bones) {
    for (int joint : {bone.parent, bone.child}) {
      if (joint >= 0 && joint < first.joint_count()) continue;
      return absl::InvalidArgumentError(
          absl::StrCat("bones: expected joints 0 to ", first.joint_count() - 1, ", got ", joint));
    }
  }
  return absl::OkStatus();
}

json MotionJson(const GalleryMotion& motion) {
  json object = {{"name", motion.name},
                 {"frameRate", motion.leader.frame_rate_hz},
                 {"frames", motion.leader.frame_count()},
                 {"leader", EncodePositions(motion.leader)}};
  if (motion.follower) object["follower"] = EncodePositions(*motion.follower);
  return object;
}

// {title, subtitle, joints, bones, motions [{name, frameRate, frames, leader, follower?}]}
json Data(const GalleryContent& content) {
  json motions = json::array(), bones = json::array();
  for (const GalleryMotion& motion : content.motions) motions.push_back(MotionJson(motion));
  for (const motion::Bone& bone : content.bones) bones.push_back({bone.parent, bone.child});
  return {{"title", content.title},
          {"subtitle", content.subtitle},
          {"joints", content.motions[0].leader.joint_names},
          {"bones", bones},
          {"motions", motions}};
}

}  // namespace

absl::StatusOr<std::string> RenderGallery(const GalleryContent& content) {
  absl::Status status = Check(content);
  if (!status.ok()) return status;
  return FillPage({Embedded(duet_gallery, duet_gallery_end), content.title,
                   Embedded(duet_gallery_style, duet_gallery_style_end), SafeJson(Data(content)),
                   Embedded(duet_gallery_script, duet_gallery_script_end)});
}

}  // namespace duet::client::viewer
