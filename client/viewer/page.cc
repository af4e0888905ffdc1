#include "client/viewer/page.h"

#include "absl/strings/str_cat.h"
#include "client/viewer/page_data.h"
#include "client/viewer/page_parts.h"

// Embedded by duet_embed_file.
extern "C" {
extern const char duet_page_index[], duet_page_index_end[];
extern const char duet_page_stage[], duet_page_stage_end[];
extern const char duet_page_element[], duet_page_element_end[];
extern const char duet_page_gif[], duet_page_gif_end[];
extern const char duet_page_panel[], duet_page_panel_end[];
extern const char duet_page_measures[], duet_page_measures_end[];
extern const char duet_page_exporting[], duet_page_exporting_end[];
extern const char duet_page_metronome[], duet_page_metronome_end[];
extern const char duet_page_grade[], duet_page_grade_end[];
extern const char duet_page_main[], duet_page_main_end[];
}

namespace duet::client::viewer {
namespace {

absl::Status Check(const PageContent& content) {
  const motion::Clip& leader = content.pair.leader;
  const motion::Clip& follower = content.pair.follower;
  if (leader.frame_count() < 1 || leader.frame_rate_hz <= 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("pair.leader: expected at least one frame and a rate above 0, got ",
                     leader.frame_count(), " frames at ", leader.frame_rate_hz, " Hz"));
  }
  if (leader.joint_names != follower.joint_names ||
      leader.poses.joint_count() != leader.joint_count() ||
      follower.poses.joint_count() != follower.joint_count() ||
      leader.poses.all().size() != follower.poses.all().size() ||
      leader.frame_rate_hz != follower.frame_rate_hz) {
    return absl::InvalidArgumentError(
        "pair: expected equal joints, frames and rates of leader and follower");
  }
  for (const motion::Clip* clip : {&leader, &follower}) {
    for (const motion::Vec3& position : clip->poses.all()) {
      if (IsFinite(position)) continue;
      return absl::InvalidArgumentError("pair: expected finite positions, got one that is not");
    }
  }
  for (const motion::Bone& bone : content.bones) {
    for (int joint : {bone.parent, bone.child}) {
      if (joint < 0 || joint >= leader.joint_count()) {
        return absl::InvalidArgumentError(absl::StrCat("bones: expected joints 0 to ",
                                                       leader.joint_count() - 1, ", got ", joint));
      }
    }
  }
  if (content.beat && !(content.beat->per_minute > 0)) {
    return absl::InvalidArgumentError(
        absl::StrCat("beat: expected a rate above 0, got ", content.beat->per_minute));
  }
  return absl::OkStatus();
}

std::string Script() {
  return absl::StrCat(
      SharedScript(), Embedded(duet_page_stage, duet_page_stage_end),
      Embedded(duet_page_element, duet_page_element_end),
      Embedded(duet_page_gif, duet_page_gif_end), Embedded(duet_page_panel, duet_page_panel_end),
      Embedded(duet_page_measures, duet_page_measures_end),
      Embedded(duet_page_exporting, duet_page_exporting_end),
      Embedded(duet_page_metronome, duet_page_metronome_end),
      Embedded(duet_page_grade, duet_page_grade_end), Embedded(duet_page_main, duet_page_main_end));
}

}  // namespace

absl::StatusOr<std::string> RenderPage(const PageContent& content) {
  absl::Status status = Check(content);
  if (!status.ok()) return status;
  return FillPage({Embedded(duet_page_index, duet_page_index_end), content.title,
                   std::string(SharedStyle()), PageDataJson(content), Script()});
}

}  // namespace duet::client::viewer
