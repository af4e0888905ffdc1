#include "client/internal/live_state.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/internal/proto_conversion.h"

namespace duet::client::internal {
namespace {

// Longer gaps are an error of the server, which would end the session.
constexpr double kLongestGapSeconds = 2;
// Leader frames that may wait for an answer: the longest outage that a session survives.
constexpr double kLongestBacklogSeconds = 120;
// Leader frames in a start.
constexpr double kLongestStartSeconds = 10;
constexpr absl::Duration kLongestEase = absl::Seconds(10);

template <typename... Parts>
absl::Status Malformed(const Parts&... parts) {
  return absl::InternalError(absl::StrCat("the server's answer is malformed: ", parts...));
}

std::vector<WeightKeyframe> FirstLabels(const LiveRequest& request) {
  if (!request.keyframes.empty()) return request.keyframes;
  return {{0, request.weights}};
}

v1::SynthesizeLiveRequest FramesMessage(int first_frame, int frame_count,
                                        absl::Span<const motion::Vec3> positions,
                                        double capture_seconds) {
  v1::SynthesizeLiveRequest message;
  v1::LeaderFrames* frames = message.mutable_frames();
  frames->set_first_frame(static_cast<uint32_t>(first_frame));
  frames->set_frame_count(static_cast<uint32_t>(frame_count));
  AppendPositions(positions, frames->mutable_positions());
  frames->set_capture_seconds(capture_seconds);
  return message;
}

bool AllFinite(const google::protobuf::RepeatedField<float>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return std::isfinite(value); });
}

std::optional<LiveNotice::Kind> ToKind(v1::LiveNoticeKind kind) {
  switch (kind) {
    case v1::LIVE_NOTICE_KIND_GAP_FILLED:
      return LiveNotice::Kind::kGapFilled;
    case v1::LIVE_NOTICE_KIND_LATE:
      return LiveNotice::Kind::kLate;
    case v1::LIVE_NOTICE_KIND_SKIPPED:
      return LiveNotice::Kind::kSkipped;
    case v1::LIVE_NOTICE_KIND_DRAINING:
      return LiveNotice::Kind::kDraining;
    default:  // of a newer server
      return std::nullopt;
  }
}

// `share` of the way from `a` to `b`. Contains the classes of both.
std::vector<ClassWeight> Mix(const std::vector<ClassWeight>& a, const std::vector<ClassWeight>& b,
                             float share) {
  std::map<std::string, float> mixed;
  for (const ClassWeight& weight : a) {
    mixed[weight.interaction_class] += (1 - share) * weight.weight;
  }
  for (const ClassWeight& weight : b) mixed[weight.interaction_class] += share * weight.weight;
  std::vector<ClassWeight> weights;
  for (const auto& [name, weight] : mixed) weights.push_back({name, weight});
  return weights;
}

void KeepSign(const motion::UnitQuaternion& before, motion::UnitQuaternion* q) {
  if (before.x * q->x + before.y * q->y + before.z * q->z + before.w * q->w < 0) {
    *q = {-q->x, -q->y, -q->z, -q->w};
  }
}

}  // namespace

std::vector<ClassWeight> LabelTrack::At(int frame) const {
  const auto after =
      std::find_if(keyframes_.begin(), keyframes_.end(),
                   [frame](const WeightKeyframe& keyframe) { return keyframe.frame > frame; });
  if (after == keyframes_.begin()) {
    return after == keyframes_.end() ? std::vector<ClassWeight>() : after->weights;
  }
  const WeightKeyframe& before = *(after - 1);
  if (after == keyframes_.end() || before.frame == frame) return before.weights;
  const float share =
      static_cast<float>(frame - before.frame) / static_cast<float>(after->frame - before.frame);
  return Mix(before.weights, after->weights, share);
}

void LabelTrack::Append(int frame, std::vector<ClassWeight> weights) {
  while (!keyframes_.empty() && keyframes_.back().frame >= frame) keyframes_.pop_back();
  keyframes_.push_back({frame, std::move(weights)});
}

void LabelTrack::Change(int frame, const std::vector<ClassWeight>& weights, int ease_frames) {
  if (ease_frames > 0) {
    Append(frame, At(frame));
    Append(frame + ease_frames, weights);
    return;
  }
  // A step needs the old weights one frame before it.
  if (frame > 0) Append(frame - 1, At(frame - 1));
  Append(frame, weights);
}

std::vector<WeightKeyframe> LabelTrack::From(int frame) const {
  std::size_t first = 0;
  while (first + 1 < keyframes_.size() && keyframes_[first + 1].frame <= frame) ++first;
  return {keyframes_.begin() + static_cast<std::ptrdiff_t>(first), keyframes_.end()};
}

absl::StatusOr<std::optional<motion::JointRotations>> LiveRotations::Read(
    const v1::FollowerFrames& frames, int known) {
  const bool expects_rig = wanted_ && !has_rig_;
  if (frames.rig().empty() == expects_rig) {
    return absl::InvalidArgumentError(
        expects_rig
            ? "frames.rig: expected joints in the first frames of a stream, got none; does the "
              "server know reply_rotations?"
            : "frames.rig: expected joints only for rotations, in the first frames, got some");
  }
  if (expects_rig) {
    absl::StatusOr<std::vector<motion::RestJoint>> rig =
        ReadRig("frames.rig", frames.rig(), joint_count_);
    if (!rig.ok()) return rig.status();
    rig_ = *std::move(rig);
    has_rig_ = true;
  }
  absl::Status status =
      CheckRotations("frames.rotations", frames.rotations(), frames.frame_count(), rig_.size());
  if (!status.ok()) return status;
  if (!wanted_) return std::nullopt;
  motion::JointRotations read{rig_, {}};
  AppendRotations(frames.rotations(), &read.rotations);
  const auto width = static_cast<std::ptrdiff_t>(rig_.size());
  read.rotations.erase(read.rotations.begin(), read.rotations.begin() + known * width);
  if (read.rotations.empty()) return std::nullopt;
  if (last_.size() != rig_.size())
    last_.assign(read.rotations.begin(), read.rotations.begin() + width);
  for (std::size_t i = 0; i < read.rotations.size(); ++i) {
    const std::size_t joint = i % rig_.size();
    KeepSign(last_[joint], &read.rotations[i]);
    last_[joint] = read.rotations[i];
  }
  return read;
}

absl::StatusOr<LiveState> LiveState::Create(LiveRequest request) {
  v1::LiveStart start;
  absl::Status status =
      FillFormat(request.joint_names, request.frame_rate_hz, start.mutable_leader());
  if (status.ok()) status = FillReaction(request, &start);
  if (!status.ok()) return status;
  if (request.delay_frames < 0 || request.plan_frames < 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("delay_frames and plan_frames: expected 0 or more, got ", request.delay_frames,
                     " and ", request.plan_frames));
  }
  start.set_delay_frames(static_cast<uint32_t>(request.delay_frames));
  start.set_plan_frames(static_cast<uint32_t>(request.plan_frames));
  return LiveState(std::move(request), std::move(start));
}

LiveState::LiveState(LiveRequest request, v1::LiveStart start)
    : request_(std::move(request)),
      start_(std::move(start)),
      leader_(static_cast<int>(request_.joint_names.size())),
      follower_(static_cast<int>(request_.joint_names.size())),
      rotations_(request_.rotations, static_cast<int>(request_.joint_names.size())),
      labels_(FirstLabels(request_)) {}

absl::Status LiveState::CheckIndices(int first_frame, size_t points) const {
  const size_t joints = request_.joint_names.size();
  if (points == 0 || points % joints != 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("frames.positions: expected a multiple of ", joints, " points, got ", points));
  }
  const auto frames = static_cast<int64_t>(points / joints);
  if (first_frame < 0 || first_frame + frames > std::numeric_limits<int>::max()) {
    return absl::InvalidArgumentError(
        absl::StrCat("frames.first_frame: expected 0 or more, got ", first_frame));
  }
  const double rate = request_.frame_rate_hz;
  const int missing = first_frame - leader_.end();
  if (missing > 0 && (leader_.end() == 0 || missing > kLongestGapSeconds * rate)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "frames.first_frame: expected ", leader_.end(),
        leader_.end() == 0 ? "" : absl::StrCat(" or at most ", kLongestGapSeconds, " s later"),
        ", got ", first_frame));
  }
  if (static_cast<double>(first_frame + frames - delivered_) > kLongestBacklogSeconds * rate) {
    return absl::ResourceExhaustedError(absl::StrCat(
        "frames: expected at most ", kLongestBacklogSeconds, " s of frames without an answer, got ",
        leader_.end() - delivered_, " frames; send them at their frame rate"));
  }
  return absl::OkStatus();
}

// The server does the same; here it is for the history of a resumed session.
void LiveState::FillGap(int first_frame, absl::Span<const motion::Vec3> next,
                        double capture_seconds) {
  const int missing = first_frame - leader_.end();
  if (missing <= 0) return;
  const int last = leader_.end() - 1;
  const std::vector<motion::Vec3> before(leader_[last].begin(), leader_[last].end());
  const double before_seconds = capture_seconds_.back();
  for (int i = 1; i <= missing; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(missing + 1);
    std::vector<motion::Vec3> pose(before.size());
    for (size_t joint = 0; joint < pose.size(); ++joint) {
      pose[joint] = before[joint] + (next[joint] - before[joint]) * share;
    }
    leader_.Append(pose);
    capture_seconds_.push_back(before_seconds +
                               (capture_seconds - before_seconds) * static_cast<double>(share));
  }
}

absl::StatusOr<v1::SynthesizeLiveRequest> LiveState::AddFrames(
    int first_frame, absl::Span<const motion::Vec3> positions, double capture_seconds) {
  absl::Status status = CheckIndices(first_frame, positions.size());
  if (!status.ok()) return status;
  const size_t joints = request_.joint_names.size();
  const int frames = static_cast<int>(positions.size() / joints);
  FillGap(first_frame, positions.subspan(0, joints), capture_seconds);
  if (leader_.end() == 0) rig_leader_.assign(positions.begin(), positions.begin() + joints);
  const int known = std::clamp(leader_.end() - first_frame, 0, frames);
  leader_.Append(positions.subspan(static_cast<size_t>(known) * joints));
  capture_seconds_.resize(static_cast<size_t>(leader_.end() - capture_first_), capture_seconds);
  summary_.leader_frames = leader_.end();
  return FramesMessage(first_frame, frames, positions, capture_seconds);
}

absl::StatusOr<v1::SynthesizeLiveRequest> LiveState::ChangeLabels(
    const std::vector<ClassWeight>& weights, absl::Duration ease) {
  if (weights.empty()) {
    return absl::InvalidArgumentError("label_change.label_vector: expected a weight, got none");
  }
  if (ease < absl::ZeroDuration() || ease > kLongestEase) {
    return absl::InvalidArgumentError(absl::StrCat("label_change.ease: expected 0 to ",
                                                   absl::FormatDuration(kLongestEase), ", got ",
                                                   absl::FormatDuration(ease)));
  }
  const int frame = std::max(0, leader_.end() - request_.delay_frames);
  const auto ease_frames =
      static_cast<int>(std::floor(absl::ToDoubleSeconds(ease) * request_.frame_rate_hz + 1e-9));
  labels_.Change(frame, weights, ease_frames);
  labels_changed_ = true;
  v1::SynthesizeLiveRequest message;
  v1::LabelChange* change = message.mutable_label_change();
  change->set_frame(static_cast<uint32_t>(frame));
  Fill(weights, change->mutable_label_vector());
  change->set_ease_frames(static_cast<uint32_t>(ease_frames));
  return message;
}

v1::LiveStart LiveState::StartWithHistory(int answered, int first) {
  v1::LiveStart start = start_;
  if (info_.has_value()) {
    // So that all frames come from the same version, cleaned up in the same way.
    start.mutable_model()->set_name(info_->model_name);
    start.mutable_model()->set_version(static_cast<uint32_t>(info_->model_version));
    start.set_seed(info_->seed);  // that the server chose, if the request has none
    start.set_clean_up(info_->cleaned_up ? v1::CLEAN_UP_ON : v1::CLEAN_UP_OFF);
  }
  if (labels_changed_ || start.label_keyframes_size() > 0) {
    start.clear_label_vector();
    start.clear_label_keyframes();
    for (const WeightKeyframe& keyframe : labels_.From(first)) {
      // Cannot fail: the frame is not negative.
      Fill(keyframe, 0, start.add_label_keyframes()).IgnoreError();
    }
  }
  if (answered == 0) return start;
  start.clear_follower_start();
  const int leaders = StartEnd(answered, first) - first;
  start.mutable_leader()->set_frame_count(static_cast<uint32_t>(leaders));
  AppendPositions(leader_.Frames(first, leaders), start.mutable_leader()->mutable_positions());
  v1::LiveHistory* history = start.mutable_history();
  history->set_first_frame(static_cast<uint32_t>(first));
  history->set_follower_frame_count(static_cast<uint32_t>(answered - first));
  AppendPositions(follower_.Frames(first, answered - first), history->mutable_follower_positions());
  if (request_.rotations) {
    AppendPositions(rig_leader_, history->mutable_rig_leader_positions());
    AppendPositions(rig_follower_, history->mutable_rig_follower_positions());
  }
  return start;
}

// The leader frames that have no answer belong to the start: the server evaluates all of those,
// whereas it skips evaluations for frames that queue up later.
int LiveState::StartEnd(int answered, int first) const {
  if (answered == 0) return 0;
  const int most = first + static_cast<int>(kLongestStartSeconds * request_.frame_rate_hz);
  return std::clamp(most, answered + request_.delay_frames, leader_.end());
}

std::deque<v1::SynthesizeLiveRequest> LiveState::BeginStream() {
  is_open_ = has_summary_ = false;
  rotations_.BeginStream();
  // At the end of the leader's motion, the server also answers frames within the delay, which the
  // history may not hold.
  const int answered = std::min(delivered_, std::max(0, leader_.end() - request_.delay_frames));
  const int first = std::max(0, answered - history_frames_);
  next_frame_ = answered;
  std::deque<v1::SynthesizeLiveRequest> messages(1);
  *messages[0].mutable_start() = StartWithHistory(answered, first);
  for (int frame = StartEnd(answered, first); frame < leader_.end(); ++frame) {
    messages.push_back(FramesMessage(
        frame, 1, leader_[frame], capture_seconds_[static_cast<size_t>(frame - capture_first_)]));
  }
  return messages;
}

absl::StatusOr<LiveAnswer> LiveState::Accept(const v1::SynthesizeLiveResponse& response) {
  if (has_summary_) return Malformed("a message after the summary");
  if (response.has_header()) {
    absl::Status status = AcceptHeader(response.header());
    if (!status.ok()) return status;
    return LiveAnswer{};
  }
  if (!is_open_) return Malformed("expected a header first, got another message");
  switch (response.payload_case()) {
    case v1::SynthesizeLiveResponse::kFrames:
      return AcceptFrames(response.frames());
    case v1::SynthesizeLiveResponse::kNotice:
      return AcceptNotice(response.notice());
    case v1::SynthesizeLiveResponse::kSummary: {
      has_summary_ = true;
      return LiveAnswer{};
    }
    default:
      return Malformed("a message without a payload");
  }
}

absl::Status LiveState::AcceptHeader(const v1::LiveHeader& header) {
  if (is_open_) return Malformed("a second header");
  const absl::Status echo = CheckHeader(header, request_.joint_names, request_.frame_rate_hz);
  if (!echo.ok()) return Malformed(echo.message());
  if (header.first_frame() != static_cast<uint32_t>(next_frame_)) {
    return Malformed("header.first_frame: expected ", next_frame_, ", got ", header.first_frame());
  }
  if (header.delay_frames() != start_.delay_frames()) {
    return Malformed("header.delay_frames: expected the request's ", start_.delay_frames(),
                     ", got ", header.delay_frames());
  }
  is_open_ = true;
  history_frames_ = static_cast<int>(std::min<uint32_t>(header.history_frames(), 100000));
  if (info_.has_value()) {
    ++summary_.resumed;
  } else {
    info_.emplace().delay_frames = static_cast<int>(header.delay_frames());
    ReadHeader(header, &*info_);
  }
  return absl::OkStatus();
}

absl::Status LiveState::CheckFrames(const v1::FollowerFrames& frames) const {
  if (frames.first_frame() != static_cast<uint32_t>(next_frame_)) {
    return Malformed("frames.first_frame: expected ", next_frame_, ", got ", frames.first_frame());
  }
  const int left = leader_.end() - next_frame_;
  if (frames.frame_count() < 1 || frames.frame_count() > static_cast<uint32_t>(left)) {
    return Malformed("frames.frame_count: expected 1 to ", left, ", got ", frames.frame_count());
  }
  const size_t width = request_.joint_names.size() * 3;
  if (static_cast<size_t>(frames.positions_size()) != frames.frame_count() * width) {
    return Malformed("frames.positions: expected ", frames.frame_count() * width, " values for ",
                     frames.frame_count(), " frames, got ", frames.positions_size());
  }
  const auto planned = static_cast<size_t>(frames.plan_positions_size());
  if (planned % width != 0 || planned / width > static_cast<size_t>(request_.plan_frames)) {
    return Malformed("frames.plan_positions: expected at most ", request_.plan_frames,
                     " frames of ", width, " values, got ", planned, " values");
  }
  if (!AllFinite(frames.positions()) || !AllFinite(frames.plan_positions())) {
    return Malformed("frames.positions: expected finite values, got another from frame ",
                     next_frame_, " on");
  }
  return absl::OkStatus();
}

// Of the leader frame that the answer is from. The server does not know those of a start.
double LiveState::CaptureSeconds(const v1::FollowerFrames& frames) const {
  const int64_t kept = int64_t{frames.leader_frame()} - capture_first_;
  if (kept < 0 || kept >= static_cast<int64_t>(capture_seconds_.size())) {
    return frames.capture_seconds();
  }
  return capture_seconds_[static_cast<size_t>(kept)];
}

absl::StatusOr<LiveAnswer> LiveState::AcceptFrames(const v1::FollowerFrames& frames) {
  absl::Status status = CheckFrames(frames);
  if (!status.ok()) return status;
  const int joints = static_cast<int>(request_.joint_names.size());
  LiveFrames out;
  out.poses = motion::Poses(joints, ToPoints(frames.positions()));
  out.plan = motion::Poses(joints, ToPoints(frames.plan_positions()));
  out.leader_frame = static_cast<int>(frames.leader_frame());
  out.capture_seconds = CaptureSeconds(frames);
  out.server_time = absl::Seconds(frames.server_seconds());
  next_frame_ += out.poses.frame_count();
  // A resumed stream may begin with frames that the caller has.
  const int known = out.poses.frame_count() - std::max(0, next_frame_ - delivered_);
  absl::StatusOr<std::optional<motion::JointRotations>> rotations =
      rotations_.Read(frames, std::clamp(known, 0, out.poses.frame_count()));
  if (!rotations.ok()) return Malformed(rotations.status().message());
  out.rotations = *std::move(rotations);
  out.poses.DropFront(std::min(known, out.poses.frame_count()));
  if (out.poses.empty()) return LiveAnswer{};
  out.first_frame = delivered_;
  if (delivered_ == 0) rig_follower_.assign(out.poses[0].begin(), out.poses[0].end());
  delivered_ = next_frame_;
  summary_.follower_frames = delivered_;
  follower_.Append(out.poses.all());
  Prune();
  return LiveAnswer{std::move(out), std::nullopt};
}

absl::StatusOr<LiveAnswer> LiveState::AcceptNotice(const v1::LiveNotice& notice) {
  const std::optional<LiveNotice::Kind> kind = ToKind(notice.kind());
  if (!kind.has_value()) return LiveAnswer{};
  LiveNotice out;
  out.kind = *kind;
  out.frames = {static_cast<int>(notice.frames().first_frame()),
                static_cast<int>(notice.frames().frame_count())};
  const int count = std::max(0, out.frames.frame_count);
  if (out.kind == LiveNotice::Kind::kGapFilled) summary_.gap_frames += count;
  if (out.kind == LiveNotice::Kind::kLate) summary_.late_frames += count;
  if (out.kind == LiveNotice::Kind::kSkipped) summary_.skipped_frames += count;
  return LiveAnswer{std::nullopt, std::move(out)};
}

void LiveState::Prune() {
  const int first = delivered_ - request_.delay_frames - history_frames_;
  follower_.DropBefore(first);
  leader_.DropBefore(first);
  if (capture_first_ == leader_.first()) return;
  capture_seconds_.erase(capture_seconds_.begin(),
                         capture_seconds_.begin() + (leader_.first() - capture_first_));
  capture_first_ = leader_.first();
}

}  // namespace duet::client::internal
