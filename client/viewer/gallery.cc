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
