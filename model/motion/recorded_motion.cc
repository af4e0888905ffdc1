#include "model/motion/recorded_motion.h"

#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "model/motion/motion_limits.h"

namespace duet::motion {
namespace {

bool IsWritable(Vec3 position) {
  for (float value : {position.x, position.y, position.z}) {
    if (!(std::abs(value) <= static_cast<float>(kMaxCoordinate))) return false;
  }
  return true;
}

}  // namespace

absl::Status CheckClip(absl::string_view name, const Clip& clip) {
  if (clip.frame_count() < 1) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": expected at least 1 frame, got none"));
  }
  if (clip.poses.joint_count() != clip.joint_count()) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": expected poses of ", clip.joint_count(),
                                                   " joints, one for each "
                                                   "name, got ",
                                                   clip.poses.joint_count()));
  }
  const std::size_t joints = clip.joint_names.size();
  for (std::size_t i = 0; i < clip.poses.all().size(); ++i) {
    if (IsWritable(clip.poses.all()[i])) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": frame ", i / joints, " ", clip.joint_names[i % joints],
                     ": expected a finite position within +-", kMaxCoordinate, " m, got another"));
  }
  return CheckFrameRate(name, clip.frame_rate_hz);
}

absl::Status CheckPair(const ClipPair& pair) {
  const Clip& a = pair.leader;
  const Clip& b = pair.follower;
  if (a.joint_names != b.joint_names || a.poses.all().size() != b.poses.all().size() ||
      a.frame_rate_hz != b.frame_rate_hz) {
    return absl::InvalidArgumentError(absl::StrCat(
        "pair: expected the same joints, frames and rate, got a leader of ", a.frame_count(),
        " frames x ", a.joint_count(), " joints at ", a.frame_rate_hz, " Hz and a follower of ",
        b.frame_count(), " x ", b.joint_count(), " at ", b.frame_rate_hz, " Hz"));
  }
  absl::Status status = CheckClip("leader", a);
  return status.ok() ? CheckClip("follower", b) : status;
}

absl::Status CheckPeople(const std::vector<Clip>& people, const Skeleton& skeleton) {
  if (people.empty() || people.size() > 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("people: expected one or two, got ", people.size()));
  }
  for (const Clip& person : people) {
    if (person.joint_names == skeleton.joint_names) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("people: expected the skeleton's ", skeleton.joint_count(),
                     " joints in its order, got ", person.joint_count()));
  }
  return people.size() == 1 ? CheckClip("person", people[0])
                            : CheckPair(ClipPair{people[0], people[1]});
}

}  // namespace duet::motion
