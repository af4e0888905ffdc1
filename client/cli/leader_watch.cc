#include "client/cli/leader_watch.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/analysis/skeleton_check.h"
#include "model/base/index.h"

namespace duet::client::cli {

using base::Index;

LeaderWatch::LeaderWatch(std::unique_ptr<live::LeaderSource> source, motion::Skeleton skeleton,
                         std::function<void(const std::string&)> on_note)
    : source_(std::move(source)), skeleton_(std::move(skeleton)), on_note_(std::move(on_note)) {}

absl::StatusOr<live::LeaderFormat> LeaderWatch::Open() {
  absl::StatusOr<live::LeaderFormat> format = source_->Open();
  if (!format.ok()) return format;
  const std::vector<std::string>& names = format->joint_names;
  for (const std::string& joint : skeleton_.joint_names) {
    const auto at = std::find(names.begin(), names.end(), joint);
    source_joints_.push_back(static_cast<int>(at - names.begin()));
  }
  seen_.joint_names = skeleton_.joint_names;
  seen_.frame_rate_hz = format->frame_rate_hz;
  seen_.poses = motion::Poses(0, seen_.joint_count());
  return format;
}

absl::StatusOr<std::optional<live::LeaderEvent>> LeaderWatch::Next() {
  absl::StatusOr<std::optional<live::LeaderEvent>> event = source_->Next();
  if (checked_) return event;
  if (!event.ok() || !event->has_value()) {
    Check();
  } else if (const auto* frame = std::get_if<live::LeaderFrame>(&**event)) {
    Watch(*frame);
  }
  return event;
}

void LeaderWatch::Watch(const live::LeaderFrame& frame) {
  std::vector<motion::Vec3> pose;
  pose.reserve(source_joints_.size());
  for (const int joint : source_joints_) {
    if (Index(joint) >= frame.positions.size()) return;  // the session rejects it
    pose.push_back(frame.positions[Index(joint)]);
  }
  seen_.poses.Append(pose);
  if (seen_.frame_count() >= kWatchSeconds * seen_.frame_rate_hz) Check();
}

void LeaderWatch::Check() {
  checked_ = true;
  const motion::Clip seen = std::exchange(seen_, {});
  if (seen.frame_count() == 0) return;
  for (const analysis::Check& check : analysis::CheckSkeleton(seen, skeleton_)) {
    if (check.name != "sides" || check.good) continue;
    note_ = absl::StrCat("leader: ", check.text,
                         "; if the sender is left-handed (Unity, Unreal), negate one axis");
    if (on_note_) on_note_(note_);
  }
}

std::vector<std::string> LeaderWatch::Notes() const {
  std::vector<std::string> notes = source_->Notes();
  if (!note_.empty()) notes.push_back(note_);
  return notes;
}

}  // namespace duet::client::cli
