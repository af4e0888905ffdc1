#include "server/service/validate_live.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.pb.h"
#include "server/service/request_fields.h"
#include "server/service/validator.h"
#include "server/service/violations.h"

namespace duet::server::service {
namespace {

constexpr char kPrefix[] = "start.";
constexpr double kMaxDelaySeconds = 0.5;

// The fields that a session and a clip have in common, as a clip's request.
v1::SynthesizeRequest ToRequest(v1::LiveStart* start, const engine::ModelDescription& model) {
  v1::SynthesizeRequest request;
  if (start->has_leader()) request.mutable_leader()->Swap(start->mutable_leader());
  if (start->has_label_vector()) {
    request.mutable_label_vector()->Swap(start->mutable_label_vector());
  }
  request.mutable_label_keyframes()->Swap(start->mutable_label_keyframes());
  if (start->has_follower_start()) {
    request.mutable_follower_start()->Swap(start->mutable_follower_start());
  }
  if (start->has_partner_direction()) {
    *request.mutable_partner_direction() = start->partner_direction();
  }
  // The leader, which clips derive a seed from, is not known yet.
  const uint64_t first = model.default_seeds.empty() ? 0 : model.default_seeds.front();
  request.set_seed(start->has_seed() ? start->seed() : first);
  if (start->has_variety()) request.set_variety(start->variety());
  request.set_clean_up(start->clean_up());
  if (start->has_reaction()) request.set_reaction(start->reaction());
  if (start->has_candidates()) request.set_candidates(start->candidates());
  if (start->has_up()) *request.mutable_up() = start->up();
  request.set_reply_rotations(start->reply_rotations());
  return request;
}

// Limits on the leader of a LiveStart: its history.
RequestLimits HistoryLimits(RequestLimits limits) {
  limits.min_frames = 0;
  limits.max_duration_seconds = limits.max_live_seconds;
  return limits;
}

void ValidateCounts(const v1::LiveStart& start, double frame_rate_hz, const RequestLimits& limits,
                    Violations& violations) {
  const uint32_t delay = start.delay_frames(), plan = start.plan_frames();
  if (delay > static_cast<uint32_t>(limits.max_delay_frames)) {
    violations.Malformed("delay_frames", absl::StrCat("0 to ", limits.max_delay_frames),
                         absl::StrCat(delay));
  } else if (delay > kMaxDelaySeconds * frame_rate_hz) {
    violations.Malformed("delay_frames", absl::StrCat("at most ", kMaxDelaySeconds, " s"),
                         absl::StrCat(delay, " frames at ", frame_rate_hz, " frames per second"));
  }
  if (plan > static_cast<uint32_t>(limits.max_plan_frames)) {
    violations.Malformed("plan_frames", absl::StrCat("0 to ", limits.max_plan_frames),
                         absl::StrCat(plan));
  }
}

void ReadHistory(const v1::LiveStart& start, const RequestLimits& limits, ValidatedLiveStart* valid,
                 Violations& violations) {
  if (!start.has_history()) return;
  const v1::LiveHistory& history = start.history();
  const int leader_frames = valid->live.leader.frame_count();
  if (valid->live.start.has_value()) {
    violations.Malformed("follower_start", "no value together with history", "one");
  }
  if (history.first_frame() >= static_cast<uint32_t>(kMaxLiveFrames)) {
    violations.Malformed("history.first_frame", absl::StrCat("less than ", kMaxLiveFrames),
                         absl::StrCat(history.first_frame()));
  }
  if (leader_frames == 0) {
    violations.Malformed("leader.frame_count", "the leader's frames from history.first_frame on",
                         "0");
    return;
  }
  const uint32_t frames = history.follower_frame_count();
  if (frames < 1 || frames > static_cast<uint32_t>(leader_frames)) {
    violations.Malformed("history.follower_frame_count",
                         absl::StrCat("1 to ", leader_frames, ", the frames of leader"),
                         absl::StrCat(frames));
    return;
  }
  constexpr char kField[] = "history.follower_positions";
  const auto& positions = history.follower_positions();
  const auto joints = static_cast<int>(valid->reply.joints.size());
  if (!ValidateCount(kField, positions.size(), frames, joints, violations) ||
      !ValidateFinite(kField, positions, violations)) {
    return;
  }
  const motion::Poses follower = ReadPositions(kField, positions, valid->reply.joints,
                                               valid->reply.coordinates, limits, violations);
  ValidateSize(kField, follower, violations);
  if (follower.empty()) return;
  valid->live.first_frame = static_cast<int>(history.first_frame());
  valid->live.follower = FromPositions(valid->reply, positions);
}

// Reads a frame of LiveHistory: as FromPositions. Empty if there are violations.
motion::Poses ReadRigPose(const std::string& field,
                          const google::protobuf::RepeatedField<float>& positions,
                          const ReplyMapping& reply, const RequestLimits& limits,
                          Violations& violations) {
  const auto joints = static_cast<int>(reply.joints.size());
  motion::Poses none(0, joints);
  if (!ValidateCount(field, positions.size(), std::nullopt, joints, violations) ||
      !ValidateFinite(field, positions, violations)) {
    return none;
  }
  const motion::Poses pose =
      ReadPositions(field, positions, reply.joints, reply.coordinates, limits, violations);
  if (pose.empty()) return none;
  // A session may begin with a frame without a person.
  if (!IsPoint(pose[0])) ValidateSize(field, pose, violations);
  return FromPositions(reply, positions);
}

motion::Poses FirstPose(const motion::Poses& poses) {
  motion::Poses first(0, poses.joint_count());
  if (!poses.empty()) first.Append(poses[0]);
  return first;
}

void ReadRigPoses(const v1::LiveStart& start, const RequestLimits& limits,
                  ValidatedLiveStart* valid, Violations& violations) {
  if (!start.reply_rotations()) return;
  valid->rotations = true;
  if (valid->live.first_frame == 0) {
    valid->rig_leader = FirstPose(valid->live.leader);
    valid->rig_follower = FirstPose(valid->live.follower);
    return;
  }
  const v1::LiveHistory& history = start.history();
  valid->rig_leader = ReadRigPose("history.rig_leader_positions", history.rig_leader_positions(),
                                  valid->reply, limits, violations);
  valid->rig_follower =
      ReadRigPose("history.rig_follower_positions", history.rig_follower_positions(), valid->reply,
                  limits, violations);
}

}  // namespace

absl::StatusOr<ValidatedLiveStart> ValidateLiveStart(v1::LiveStart start,
                                                     const engine::ModelDescription& model,
                                                     const RequestLimits& limits) {
  if (!engine::AnswersLive(model)) {
    Violations violations(kPrefix);
    violations.Mismatch("model", "a model that answers live (Model.answers_live)",
                        absl::StrCat(model.name, " version ", model.version));
    return violations.ToStatus();
  }
  const v1::SynthesizeRequest request = ToRequest(&start, model);
  absl::StatusOr<ValidatedRequest> common = ValidateRequest(
      request, model, HistoryLimits(limits), {kPrefix, static_cast<uint32_t>(kMaxLiveFrames)});
  if (!common.ok()) return common.status();
  ValidatedLiveStart valid{{common->clip.frame_rate_hz,
                            static_cast<int>(start.delay_frames()),
                            std::move(common->clip.labels),
                            std::move(common->clip.start),
                            common->clip.partner_direction,
                            common->clip.options,
                            0,
                            std::move(common->clip.leader),
                            {}},
                           std::move(common->reply),
                           static_cast<int>(start.plan_frames())};
  valid.reply.rig.reset();  // LiveRig makes its own
  Violations violations(kPrefix);
  ValidateCounts(start, valid.live.frame_rate_hz, limits, violations);
  ReadHistory(start, limits, &valid, violations);
  ReadRigPoses(start, limits, &valid, violations);
  if (!violations.empty()) return violations.ToStatus();
  return valid;
}

absl::StatusOr<motion::Poses> ReadLeaderFrames(const v1::LeaderFrames& frames,
                                               const ReplyMapping& format,
                                               const RequestLimits& limits) {
  Violations violations("frames.");
  const auto most =
      static_cast<uint32_t>(std::max(1.0, limits.max_live_seconds * format.frame_rate_hz));
  if (frames.frame_count() < 1 || frames.frame_count() > most) {
    violations.Malformed("frame_count", absl::StrCat("1 to ", most),
                         absl::StrCat(frames.frame_count()));
  }
  if (frames.first_frame() >= static_cast<uint32_t>(kMaxLiveFrames)) {
    violations.Malformed("first_frame", absl::StrCat("less than ", kMaxLiveFrames),
                         absl::StrCat(frames.first_frame()));
  }
  ValidateCount("positions", frames.positions_size(), frames.frame_count(),
                static_cast<int>(format.joints.size()), violations);
  if (!violations.empty() || !ValidateFinite("positions", frames.positions(), violations)) {
    return violations.ToStatus();
  }
  motion::Poses poses = ReadPositions("positions", frames.positions(), format.joints,
                                      format.coordinates, limits, violations);
  if (!violations.empty()) return violations.ToStatus();
  if (format.levelling) poses = format.levelling->Apply(std::move(poses));
  return poses;
}

absl::StatusOr<ValidatedLabelChange> ReadLabelChange(const v1::LabelChange& change, int next_frame,
                                                     double frame_rate_hz,
                                                     const engine::ModelDescription& model,
                                                     const RequestLimits& limits) {
  Violations violations("label_change.");
  ValidatedLabelChange valid;
  valid.frame = next_frame;
  if (change.has_frame()) {
    if (change.frame() < static_cast<uint32_t>(next_frame) ||
        change.frame() >= static_cast<uint32_t>(kMaxLiveFrames)) {
      violations.Malformed(
          "frame",
          absl::StrCat("at least ", next_frame,
                       ", the first frame that is not final, and less than ", kMaxLiveFrames),
          absl::StrCat(change.frame()));
    }
    valid.frame = static_cast<int>(std::min(change.frame(), uint32_t{kMaxLiveFrames}));
  }
  const double most = limits.max_live_seconds * frame_rate_hz;
  if (change.ease_frames() > most) {
    violations.Malformed("ease_frames", absl::StrCat("at most ", most, ", 10 seconds"),
                         absl::StrCat(change.ease_frames()));
  }
  valid.ease_frames = static_cast<int>(std::min<double>(change.ease_frames(), most));
  valid.weights = ReadLabelVector("label_vector", change.label_vector(), model, limits, violations);
  if (!violations.empty()) return violations.ToStatus();
  return valid;
}

}  // namespace duet::server::service
