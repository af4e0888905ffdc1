#include "model/engine/finishing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "model/motion/feet.h"
#include "model/motion/limb_lengths.h"

namespace duet::engine {
namespace {

// Windows of an endless motion follow one another within a few frames.
constexpr double kEndlessEaseSeconds = 0;
constexpr double kEndlessAnticipationSeconds = 0.2;
// The time of the spring that joins a window to the frames that were sent.
constexpr double kJoinSeconds = 0.1;
// Hands aim at this share of the captured mean distance, because they come and go within an offer,
// and an arm may not reach. In classes whose bodies touch, a partner's hand is never far.
constexpr float kMeetsWithin = 0.65f;
// How far from the surface of the follower's body a fist ends. Captured people keep 0.1 m (push)
// and 0.3 m (punch), because they only act.
constexpr float kStrikeMetres = 0.15f;
// The same of a foot. Captured people keep 0.38 m on average, and step away from a kick: a follower
// who comes nearer than this leaves what they do (docs/decisions/0064-a-follower-with-a-body.md).
constexpr float kKickMetres = 0.46f;
// How far a follower may be turned away in a class in which it does not face its leader, degrees.
constexpr float kTurnedRound = 180;
// How much of the way to an offered hand the body leaves out in live sessions. A body that has come
// does not go back: the next plan begins where it is, and comes as much nearer as this plan still
// would have (docs/decisions/0065-live-by-planning-again.md).
constexpr float kLiveLeftOutMetres = 0.2f;

// The place of a class in the label vector; the number of classes if there is none of the name.
std::size_t ClassIndex(const std::vector<std::string>& classes, const std::string& name) {
  return static_cast<std::size_t>(std::find(classes.begin(), classes.end(), name) -
                                  classes.begin());
}

}  // namespace

absl::Status CheckFinite(const motion::Poses& follower) {
  if (std::all_of(follower.all().begin(), follower.all().end(), motion::IsFinite)) {
    return absl::OkStatus();
  }
  return absl::InternalError("the network's result is not finite");
}

void KeepLimbLengths(const ModelDescription& description, const SynthesisWindow& window,
                     motion::Poses* follower) {
  const motion::Skeleton& skeleton = description.skeleton;
  const bool has_pose = window.start && !window.start->pose.empty();
  std::vector<float> lengths =
      has_pose
          ? MedianBoneLengths(skeleton, motion::Poses(skeleton.joint_count(), window.start->pose))
          : MedianBoneLengths(skeleton, window.leader);
  if (!has_pose && !description.bone_ratios.empty()) {
    for (std::size_t b = 0; b < lengths.size(); ++b) {
      lengths[b] *= static_cast<float>(description.bone_ratios[b]);
    }
  }
  SetBoneLengths(skeleton, lengths, follower);
}

solver::GirdleWidths GirdleWidthsOf(const ModelDescription& description,
                                    const solver::Girdles& girdles, const SynthesisWindow& window) {
  const motion::Skeleton& skeleton = description.skeleton;
  if (window.start && !window.start->pose.empty()) {
    return girdles.Measure(motion::Poses(skeleton.joint_count(), window.start->pose));
  }
  solver::GirdleWidths widths = girdles.Measure(window.leader);
  if (!description.bone_ratios.empty()) {
    const double sum =
        std::accumulate(description.bone_ratios.begin(), description.bone_ratios.end(), 0.0);
    const float ratio = static_cast<float>(sum / static_cast<double>(skeleton.bones.size()));
    widths = {widths.hips * ratio, widths.shoulders * ratio};
  }
  return widths;
}

void ShareFloor(const motion::Skeleton& skeleton, const SynthesisWindow& window,
                motion::Poses* follower) {
  if (window.start || !skeleton.feet) return;
  const motion::Vec3 lift{
      0, LowestFoot(*skeleton.feet, window.leader) - LowestFoot(*skeleton.feet, *follower), 0};
  for (motion::Vec3& position : follower->all()) position += lift;
}

void JoinSent(const ModelDescription& description, const SynthesisWindow& window,
              motion::Poses* follower) {
  if (window.sent.empty()) return;
  const int first = window.settled.frame_count(), end = first + window.sent.frame_count();
  const int joints = follower->joint_count();
  const motion::Poses planned = *follower;
  std::copy(window.sent.all().begin(), window.sent.all().end(), (*follower)[first].begin());
  const std::vector<float> lengths = MedianBoneLengths(description.skeleton, planned);
  motion::Poses joined(0, joints);
  for (int t = end; t < follower->frame_count(); ++t) {
    const float since =
        static_cast<float>((t - end + 1) / (kJoinSeconds * description.frame_rate_hz));
    const float fall = std::exp(-since), place = (1 + since) * fall;
    const float velocity =
        since * fall * static_cast<float>(kJoinSeconds * description.frame_rate_hz);
    std::vector<motion::Vec3> pose(planned[t].begin(), planned[t].end());
    for (int j = 0; j < joints; ++j) {
      const motion::Vec3 offset = follower->at(end - 1, j) - planned.at(end - 1, j);
      const motion::Vec3 before =
          end < 2 ? offset : follower->at(end - 2, j) - planned.at(end - 2, j);
      pose[static_cast<std::size_t>(j)] += offset * place + (offset - before) * velocity;
    }
    joined.Append(pose);
  }
  SetBoneLengths(description.skeleton, lengths, &joined);
  std::copy(joined.all().begin(), joined.all().end(), (*follower)[end].begin());
}

cleanup::Touch TouchOf(const ModelDescription& description, const SynthesisWindow& window) {
  const std::size_t classes = description.classes.size();
  cleanup::Touch touch(static_cast<std::size_t>(window.leader.frame_count()), 0);
  for (std::size_t c = 0; c < classes; ++c) {
    const auto& names = description.touching_classes;
    if (std::find(names.begin(), names.end(), description.classes[c]) == names.end()) continue;
    for (std::size_t t = 0; t < touch.size(); ++t) {
      touch[t] += std::max(0.0f, window.labels[t * classes + c]);
    }
  }
  for (float& share : touch) share = std::min(1.0f, share);
  return touch;
}

cleanup::Meetings MeetingsOf(const ModelDescription& description, const SynthesisWindow& window) {
  const auto& classes = description.classes;
  cleanup::Meetings meetings(static_cast<std::size_t>(window.leader.frame_count()));
  for (const HandContact& contact : description.hand_contacts) {
    const std::size_t c = ClassIndex(classes, contact.interaction_class);
    const auto& touching = description.touching_classes;
    const bool touches = ClassIndex(touching, contact.interaction_class) < touching.size();
    const float nearer = touches ? 1 : kMeetsWithin;
    for (std::size_t t = 0; t < meetings.size() && c < classes.size(); ++t) {
      const float weight = std::max(0.0f, window.labels[t * classes.size() + c]);
      meetings[t].weight += weight;
      meetings[t].metres += weight * static_cast<float>(contact.metres) * nearer;
    }
  }
  for (const Strike& strike : description.strikes) {
    const bool kicks = strike.limb == StrikingLimb::kFoot;
    const std::size_t c = ClassIndex(classes, strike.interaction_class);
    for (std::size_t t = 0; t < meetings.size() && c < classes.size(); ++t) {
      const float weight = std::max(0.0f, window.labels[t * classes.size() + c]);
      (kicks ? meetings[t].foot : meetings[t].fist) += weight;
      meetings[t].strike_metres = kStrikeMetres;
      meetings[t].foot_metres = kKickMetres;
    }
  }
  const bool live = window.options.sampling.first_frame.has_value();
  for (cleanup::Meeting& meeting : meetings) {
    meeting.left_out_metres = live ? kLiveLeftOutMetres : 0;
    if (meeting.weight > 0) meeting.metres /= meeting.weight;
    meeting.weight = std::min(1.0f, meeting.weight);
    meeting.fist = std::min(1.0f, meeting.fist);
    meeting.foot = std::min(1.0f, meeting.foot);
  }
  return meetings;
}

cleanup::Options CleaningOf(const ModelDescription& description, cleanup::Options options) {
  options.stance.longest_seconds = description.longest_poses.astride;
  options.raised_limbs.longest_held_out_seconds = description.longest_poses.held_out;
  return options;
}

std::vector<float> MostAwayOf(const ModelDescription& description, const SynthesisWindow& window) {
  if (description.facing_classes.empty()) return {};
  const std::size_t classes = description.classes.size();
  std::vector<float> limits(classes, kTurnedRound);
  for (const FacingClass& facing : description.facing_classes) {
    const std::size_t c = ClassIndex(description.classes, facing.interaction_class);
    if (c < classes) limits[c] = static_cast<float>(facing.degrees);
  }
  std::vector<float> most_away(static_cast<std::size_t>(window.leader.frame_count()));
  for (std::size_t t = 0; t < most_away.size(); ++t) {
    float sum = 0, weights = 0;
    for (std::size_t c = 0; c < classes; ++c) {
      const float weight = std::max(0.0f, window.labels[t * classes + c]);
      sum += weight * limits[c];
      weights += weight;
    }
    // A follower of no class may do what those of any class do.
    most_away[t] = weights > 0 ? sum / weights : *std::max_element(limits.begin(), limits.end());
  }
  return most_away;
}

cleanup::FrameTurnOptions FrameTurnsOf(const ModelDescription& description) {
  cleanup::FrameTurnOptions options;
  if (description.turning_classes.empty()) return options;
  options.fastest_shoulder = options.fastest_hips = options.fastest_plane_of_girdle = HUGE_VAL;
  return options;
}

int SettledFrames(const SynthesisWindow& window) {
  return std::max(window.settled.frame_count(), window.start ? 1 : 0);
}

cleanup::Timing FeetTiming(const ModelDescription& description, const SynthesisWindow& window) {
  cleanup::Timing timing{description.frame_rate_hz,
                         SettledFrames(window) + window.sent.frame_count()};
  if (window.options.sampling.first_frame) {
    timing.ease_seconds = kEndlessEaseSeconds;
    timing.anticipation_seconds = kEndlessAnticipationSeconds;
    timing.continues_steps = true;
  }
  return timing;
}

}  // namespace duet::engine
