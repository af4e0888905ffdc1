#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.pb.h"
#include "server/service/request_fields.h"
#include "server/service/validator.h"

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
                    RequestFields& fields) {
  const uint32_t delay = start.delay_frames();
  if (fields.Whole("delay_frames", delay, 0, limits.max_delay_frames) &&
      delay > kMaxDelaySeconds * frame_rate_hz) {
    fields.violations().Malformed(
        "delay_frames", absl::StrCat("at most ", kMaxDelaySeconds, " s"),
        absl::StrCat(delay, " frames at ", frame_rate_hz, " frames per second"));
  }
  fields.Whole("plan_frames", start.plan_frames(), 0, limits.max_plan_frames);
}

PositionFormat FormatOf(const ReplyMapping& reply) {
  return {static_cast<int>(reply.joints.size()), reply.joints, reply.coordinates};
}

// Requires a frame number that a session can have.
void ValidateFrame(absl::string_view field, uint32_t frame, Violations& violations) {
  if (frame < static_cast<uint32_t>(kMaxLiveFrames)) return;
  violations.Malformed(field, absl::StrCat("less than ", kMaxLiveFrames), absl::StrCat(frame));
}

void ReadHistory(const v1::LiveStart& start, ValidatedLiveStart* valid, RequestFields& fields) {
  if (!start.has_history()) return;
  const v1::LiveHistory& history = start.history();
  const int leader_frames = valid->live.leader.frame_count();
  if (valid->live.start.has_value()) {
    fields.violations().Malformed("follower_start", "no value together with history", "one");
  }
  ValidateFrame("history.first_frame", history.first_frame(), fields.violations());
  if (leader_frames == 0) {
    fields.violations().Malformed("leader.frame_count",
                                  "the leader's frames from history.first_frame on", "0");
    return;
  }
  const uint32_t frames = history.follower_frame_count();
  if (!fields.Whole("history.follower_frame_count", frames, 1, leader_frames,
                    ", the frames of leader")) {
    return;
  }
  constexpr char kField[] = "history.follower_positions";
  const auto& positions = history.follower_positions();
  const motion::Poses follower =
      fields.Positions(kField, positions, frames, FormatOf(valid->reply));
  fields.Size(kField, follower);
  if (follower.empty()) return;
  valid->live.first_frame = static_cast<int>(history.first_frame());
  valid->live.follower = FromPositions(valid->reply, positions);
}

// Reads a frame of LiveHistory: as FromPositions. Empty if there are violations.
motion::Poses ReadRigPose(absl::string_view field,
                          const google::protobuf::RepeatedField<float>& positions,
                          const ReplyMapping& reply, RequestFields& fields) {
  const motion::Poses pose = fields.Positions(field, positions, std::nullopt, FormatOf(reply));
  if (pose.empty()) return motion::Poses(0, static_cast<int>(reply.joints.size()));
  // A session may begin with a frame without a person.
  if (!IsPoint(pose[0])) fields.Size(field, pose);
  return FromPositions(reply, positions);
}

motion::Poses FirstPose(const motion::Poses& poses) {
  motion::Poses first(0, poses.joint_count());
  if (!poses.empty()) first.Append(poses[0]);
  return first;
}

void ReadRigPoses(const v1::LiveStart& start, ValidatedLiveStart* valid, RequestFields& fields) {
  if (!start.reply_rotations()) return;
  valid->rotations = true;
  if (valid->live.first_frame == 0) {
    valid->rig_leader = FirstPose(valid->live.leader);
    valid->rig_follower = FirstPose(valid->live.follower);
    return;
  }
  const v1::LiveHistory& history = start.history();
  valid->rig_leader = ReadRigPose("history.rig_leader_positions", history.rig_leader_positions(),
                                  valid->reply, fields);
  valid->rig_follower = ReadRigPose("history.rig_follower_positions",
                                    history.rig_follower_positions(), valid->reply, fields);
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
  absl::StatusOr<ValidatedRequest> common =
      ValidateRequest(request, model, HistoryLimits(limits), kPrefix, kMaxLiveFrames);
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
  RequestFields fields(model, limits, kPrefix);
  ValidateCounts(start, valid.live.frame_rate_hz, limits, fields);
  ReadHistory(start, &valid, fields);
  ReadRigPoses(start, &valid, fields);
  if (!fields.violations().empty()) return fields.violations().ToStatus();
  return valid;
}

absl::StatusOr<motion::Poses> ReadLeaderFrames(const v1::LeaderFrames& frames,
                                               const ReplyMapping& format,
                                               const engine::ModelDescription& model,
                                               const RequestLimits& limits, bool check_size) {
  RequestFields fields(model, limits, "frames.");
  const int most = static_cast<int>(std::max(1.0, limits.max_live_seconds * format.frame_rate_hz));
  fields.Whole("frame_count", frames.frame_count(), 1, most);
  ValidateFrame("first_frame", frames.first_frame(), fields.violations());
  motion::Poses poses =
      fields.Positions("positions", frames.positions(), frames.frame_count(), FormatOf(format));
  if (format.levelling) poses = format.levelling->Apply(std::move(poses));
  if (check_size) fields.Size("positions", poses);
  if (!fields.violations().empty()) return fields.violations().ToStatus();
  return poses;
}

absl::StatusOr<ValidatedLabelChange> ReadLabelChange(const v1::LabelChange& change, int next_frame,
                                                     double frame_rate_hz,
                                                     const engine::ModelDescription& model,
                                                     const RequestLimits& limits) {
  RequestFields fields(model, limits, "label_change.");
  ValidatedLabelChange valid;
  valid.frame = next_frame;
  if (change.has_frame()) {
    if (change.frame() < static_cast<uint32_t>(next_frame) ||
        change.frame() >= static_cast<uint32_t>(kMaxLiveFrames)) {
      fields.violations().Malformed(
          "frame",
          absl::StrCat("at least ", next_frame,
                       ", the first frame that is not final, and less than ", kMaxLiveFrames),
          absl::StrCat(change.frame()));
    }
    valid.frame = static_cast<int>(std::min(change.frame(), uint32_t{kMaxLiveFrames}));
  }
  const double most = limits.max_live_seconds * frame_rate_hz;
  if (change.ease_frames() > most) {
    fields.violations().Malformed("ease_frames", absl::StrCat("at most ", most, ", 10 seconds"),
                                  absl::StrCat(change.ease_frames()));
  }
  valid.ease_frames = static_cast<int>(std::min<double>(change.ease_frames(), most));
  valid.weights = fields.LabelVector("label_vector", change.label_vector());
  if (!fields.violations().empty()) return fields.violations().ToStatus();
  return valid;
}

}  // namespace duet::server::service
