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
    return absl::InvalidArgumentError(absl::StrCat(name, ": no frames, wanted at least 1"));
  }
  if (clip.poses.joint_count() != clip.joint_count()) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": came poses of ",
                                                   clip.poses.joint_count(), " joints, wanted ",
                                                   clip.joint_count(), ", as there are names"));
  }
  const std::size_t joints = clip.joint_names.size();
  for (std::size_t i = 0; i < clip.poses.all().size(); ++i) {
    if (IsWritable(clip.poses.all()[i])) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": frame ", i / joints, " ", clip.joint_names[i % joints],
                     ": came a position that is not finite or beyond +-", kMaxCoordinate, " m"));
  }
  return CheckFrameRate(name, clip.frame_rate_hz);
}

absl::Status CheckPair(const ClipPair& pair) {
  const Clip& a = pair.leader;
  const Clip& b = pair.follower;
  if (a.joint_names != b.joint_names || a.poses.all().size() != b.poses.all().size() ||
      a.frame_rate_hz != b.frame_rate_hz) {
    return absl::InvalidArgumentError(absl::StrCat(
        "pair: came a leader of ", a.frame_count(), " frames x ", a.joint_count(), " joints at ",
        a.frame_rate_hz, " Hz and a follower of ", b.frame_count(), " x ", b.joint_count(), " at ",
        b.frame_rate_hz, ", wanted the same joints, frames and rate"));
  }
  absl::Status status = CheckClip("leader", a);
  return status.ok() ? CheckClip("follower", b) : status;
}

absl::Status CheckPeople(const std::vector<Clip>& people, const Skeleton& skeleton) {
  if (people.empty() || people.size() > 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("people: came ", people.size(), ", wanted one or two"));
  }
  for (const Clip& person : people) {
    if (person.joint_names == skeleton.joint_names) continue;
    return absl::InvalidArgumentError(absl::StrCat("people: came ", person.joint_count(),
                                                   " joints, wanted the skeleton's ",
                                                   skeleton.joint_count(), " in its order"));
  }
  return people.size() == 1 ? CheckClip("person", people[0])
                            : CheckPair(ClipPair{people[0], people[1]});
}

}  // namespace duet::motion
