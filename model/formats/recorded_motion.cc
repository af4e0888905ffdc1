#include "model/formats/recorded_motion.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "model/formats/text.h"

namespace duet {
namespace {

absl::Status CheckFinite(absl::string_view person, const Clip& clip) {
  for (std::size_t i = 0; i < clip.positions.size(); ++i) {
    if (IsFinite(clip.positions[i])) continue;
    const std::size_t joints = clip.joint_names.size();
    return absl::InvalidArgumentError(absl::StrCat(person, ": frame ", i / joints, " ",
                                                   clip.joint_names[i % joints],
                                                   ": came a position that is not finite"));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckPair(const ClipPair& pair) {
  const Clip& a = pair.leader;
  const Clip& b = pair.follower;
  if (a.joint_names != b.joint_names || a.positions.size() != b.positions.size() ||
      a.frame_rate_hz != b.frame_rate_hz || a.frame_count() < 1) {
    return absl::InvalidArgumentError(absl::StrCat(
        "pair: came a leader of ", a.frame_count(), " frames x ", a.joint_count(), " joints at ",
        a.frame_rate_hz, " Hz and a follower of ", b.frame_count(), " x ", b.joint_count(), " at ",
        b.frame_rate_hz, ", wanted the same joints, frames (at least 1) and rate"));
  }
  absl::Status status = CheckFrameRate("pair", a.frame_rate_hz);
  if (status.ok()) status = CheckFinite("leader", a);
  if (status.ok()) status = CheckFinite("follower", b);
  return status;
}

}  // namespace duet
