#include "model/engine/live_synthesis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

#include "model/engine/direction_estimate.h"
#include "model/engine/windows.h"
#include "model/motion/limb_lengths.h"
#include "model/motion/resample.h"
#include "model/solver/follower.h"

namespace duet::engine {
namespace {

using motion::Poses;
using motion::Vec3;

// So that a frame that coincides with a model frame is not missed because of rounding.
constexpr double kEpsilon = 1e-6;
// Evaluations a second are no more than this, whatever the model's rate.
constexpr double kMostEvaluationsHz = 15;
// How much of what was sent each plan makes anew, to continue from there. The frames right after
// settled ones hardly leave them, and clean-up eases in over this time: a motion of such frames
// alone would drift. With a delay it is longer by the delay, because plans may change more where
// more of the leader is known.
constexpr double kRemadeSeconds = 0.4;
// How far a plan reaches beyond the last frame that was sent, at least: for frames that the server
// may have to skip, and provisional frames. The more frames of a leader who comes to rest a plan
// has, the less its follower moves (docs/decisions/live.md). A model with a
// lookahead plans at least as far: its windows end with an unknown future in clips, too.
constexpr double kFutureSeconds = 0.4;
// The neighbours of a spline at the end of a plan.
constexpr int kMarginFrames = 2;
// The neighbours of splines, and rounding, at either end of the history.
constexpr int kHistoryMarginFrames = 8;

// The leader's velocity is that of its last frames, enlarged, because a motion that begins grows
// faster. It falls by a factor of e in each of these times after the last frame.
constexpr double kVelocitySeconds = 0.034;
constexpr double kEnlarged = 1.3;
constexpr double kRestSeconds = 0.3;

// Frames of a spline after the one that a time falls in.
constexpr int kFramesAfter = 2;
// Plans that follow one another add up their noise. With this share of it, the joints of live
// followers move about as fast as captured ones (docs/results: duet-eval samples, dance --live).
constexpr float kVarietyShare = 0.92f;
// The time in which a plan leaves the place of a frame between two model frames that was sent from
// the plan before it.
constexpr double kJoinSeconds = 0.06;

}  // namespace

LiveTiming::LiveTiming(const ModelDescription& model, double frame_rate_hz, int delay_frames)
    : delay_frames_(delay_frames),
      model_frames_per_frame_(model.frame_rate_hz / frame_rate_hz),
      model_frames_between_(
          std::max(1, static_cast<int>(std::lround(model.frame_rate_hz / kMostEvaluationsHz)))) {
  const double delay = std::ceil(delay_frames * model_frames_per_frame_);
  const double wanted = std::ceil(kFutureSeconds * model.frame_rate_hz - kEpsilon);
  // At least the frames that are due until the next evaluation.
  const double due = delay + model_frames_between_ + std::ceil(model_frames_per_frame_);
  future_ = std::max(
      {static_cast<int>(wanted), model.lookahead_frames, static_cast<int>(due) + kMarginFrames});
  past_ = SettledOverlap(model.window_frames);
  const int remade = static_cast<int>(std::lround(kRemadeSeconds * model.frame_rate_hz));
  const int room = model.window_frames - past_ - future_ - remade;
  remade_ = remade + std::clamp(static_cast<int>(delay), 0, std::max(0, room));
}

int LiveTiming::ModelFrameAt(int frame) const {
  return static_cast<int>(std::floor(ToModelFrame(frame) + kEpsilon));
}

int LiveTiming::history_frames() const {
  const double between = model_frames_between_ / model_frames_per_frame_;
  return static_cast<int>(std::ceil((past_ + remade_) / model_frames_per_frame_ + between)) +
         delay_frames_ + kHistoryMarginFrames;
}

bool LiveTiming::IsEvaluation(int frame) const {
  const int answered = frame - delay_frames_;
  if (answered <= 1) return answered >= 0;
  // When the frame before has completed a model frame, the plan continues exactly from there.
  return ModelFrameAt(answered - 1) / model_frames_between_ !=
         ModelFrameAt(answered - 2) / model_frames_between_;
}

int LiveTiming::EvaluationAfter(int frame) const {
  int next = std::max(frame + 1, delay_frames_);
  while (!IsEvaluation(next)) ++next;
  return next;
}

int LiveTiming::EvaluationNotAfter(int frame) const {
  int last = frame;
  while (!IsEvaluation(last)) --last;
  return last;
}

motion::Poses ComeToRest(const motion::Skeleton& skeleton, const motion::Poses& known,
                         double frame_rate_hz, absl::Span<const double> seconds) {
  const int last = known.frame_count() - 1;
  const int back =
      std::min(last, std::max(1, static_cast<int>(std::lround(kVelocitySeconds * frame_rate_hz))));
  motion::Poses resting(0, known.joint_count());
  for (const double since : seconds) {
    const double coasting = kEnlarged * kRestSeconds * (1 - std::exp(-since / kRestSeconds));
    const float steps = back == 0 ? 0 : static_cast<float>(coasting * frame_rate_hz / back);
    std::vector<motion::Vec3> pose(known[last].begin(), known[last].end());
    for (std::size_t j = 0; j < pose.size(); ++j) {
      pose[j] += (known[last][j] - known[last - back][j]) * steps;
    }
    resting.Append(pose);
  }
  if (resting.empty()) return resting;
  const motion::Poses newest(known.joint_count(), {known[last].begin(), known[last].end()});
  SetBoneLengths(skeleton, MedianBoneLengths(skeleton, newest), &resting);
  return resting;
}

bool AnswersLive(const ModelDescription& model) { return ContinuesFromSettledFrames(model); }

LiveSynthesis::LiveSynthesis(ModelDescription model, LiveRequest request)
    : model_(std::move(model)),
      request_(std::move(request)),
      timing_(model_, request_.frame_rate_hz, request_.delay_frames),
      body_(body::FindBody(model_.skeleton)),
      cleans_up_(request_.options.clean_up.value_or(model_.cleaned_up_by_default())),
      replay_end_(request_.first_frame + request_.leader.frame_count()),
      leader_(0, model_.skeleton.joint_count()),
      follower_(0, model_.skeleton.joint_count()),
      leader_begin_(request_.first_frame),
      follower_begin_(request_.first_frame) {
  // A caller may send more history than an evaluation reads.
  const int sent = request_.follower.frame_count();
  const int unread = std::max(0, sent - timing_.history_frames());
  leader_begin_ += unread;
  follower_begin_ += unread;
  leader_.Append(request_.leader.frames(unread, request_.leader.frame_count() - unread));
  follower_.Append(request_.follower.frames(unread, sent - unread));
  request_.leader = request_.follower = {};
  first_join_ = follower_.empty() ? 0 : follower_begin_ + 1;
}

void LiveSynthesis::AddLeader(const Poses& frames) { leader_.Append(frames.all()); }

void LiveSynthesis::ChangeLabels(int frame, int ease_frames, const std::vector<float>& weights) {
  request_.labels.Change(frame, ease_frames, weights);
}

int LiveSynthesis::DueEnd() const {
  return next_leader_frame() - (ended_ ? 0 : timing_.delay_frames());
}

int LiveSynthesis::JoinFrame(int evaluation) const {
  // The difference is smaller than first_join_ if the leader ended within the delay.
  return std::max(first_join_, evaluation - timing_.delay_frames());
}

std::optional<int> LiveSynthesis::NextEvaluation() const {
  if (pending_) return pending_;
  const int newest = next_leader_frame() - 1;
  return evaluation_ ? FurtherEvaluation(newest) : FirstEvaluation(newest);
}

std::optional<int> LiveSynthesis::FirstEvaluation(int newest) const {
  if (next_follower_frame() >= DueEnd() || newest < 0) return std::nullopt;
  if (newest < timing_.delay_frames()) return newest;
  // The plan that was held when the last frame was sent, unless the next one has its own. A history
  // that is too short for that plan gets a plan of its own.
  const int due = std::min(newest, next_follower_frame() + timing_.delay_frames());
  const int regular = timing_.EvaluationNotAfter(due);
  return regular - timing_.delay_frames() < first_join_ ? due : regular;
}

std::optional<int> LiveSynthesis::FurtherEvaluation(int newest) const {
  const int next = timing_.EvaluationAfter(*evaluation_);
  if (next > newest) return std::nullopt;
  if (next < replay_end_) return next;
  // The frames before the evaluation must be answered by the plan held.
  const int reach = std::min(newest, PlannedEnd() + timing_.delay_frames());
  return std::max(next, timing_.EvaluationNotAfter(std::max(next, reach)));
}

int LiveSynthesis::PlannedEnd() const {
  const int last = plan_begin_ + plan_.frame_count() - 1 - kFramesAfter;
  return static_cast<int>(std::floor(timing_.ToCallerFrame(last) + kEpsilon)) + 1;
}

LiveFrames LiveSynthesis::TakeDue() const {
  if (!evaluation_ || pending_) return {next_follower_frame(), Poses(0, leader_.joint_count())};
  int end = std::min(DueEnd(), PlannedEnd());
  if (const std::optional<int> next = NextEvaluation()) end = std::min(end, JoinFrame(*next));
  return Sample(std::min(1, end - next_follower_frame()));
}

LiveFrames LiveSynthesis::Plan(int count) const {
  if (!evaluation_) return {next_follower_frame(), Poses(0, leader_.joint_count())};
  LiveFrames frames = Sample(std::min(count, PlannedEnd() - next_follower_frame()));
  std::vector<double> beyond;  // seconds after the last planned frame
  for (int i = frames.poses.frame_count(); i < count; ++i) {
    beyond.push_back((i - frames.poses.frame_count() + 1) / request_.frame_rate_hz);
  }
  if (beyond.empty()) return frames;
  Poses known = follower_;
  known.Append(frames.poses.all());
  const Poses resting = ComeToRest(model_.skeleton, known, request_.frame_rate_hz, beyond);
  frames.poses.Append(resting.all());
  return frames;
}

LiveFrames LiveSynthesis::Sample(int count) const {
  LiveFrames frames{next_follower_frame(), Poses(0, leader_.joint_count())};
  Poses pose(1, leader_.joint_count());
  for (int i = 0; i < count; ++i) {
    SampleJoined(frames.first + i, &pose);
    frames.poses.Append(pose.all());
  }
  return frames;
}

void LiveSynthesis::SamplePlan(int frame, absl::Span<Vec3> pose) const {
  const double at = timing_.ToModelFrame(frame) - plan_begin_;
  SampleCubic(plan_, at, pose);
  const int before = static_cast<int>(std::floor(at + kEpsilon));
  if (!cleans_up_ || at - before <= kEpsilon) return;
  solver::KeepFeetBetween(body_, plan_[before], plan_[before + 1], pose);
}

void LiveSynthesis::SampleJoined(int frame, Poses* pose) const {
  SamplePlan(frame, (*pose)[0]);
  if (!offset_.empty()) {
    const double frames = kJoinSeconds * request_.frame_rate_hz, since = frame - join_frame_ + 1;
    const double fall = std::exp(-since / frames);
    const float place = static_cast<float>((1 + since / frames) * fall);
    for (std::size_t j = 0; j < offset_.size(); ++j) (*pose)[0][j] += offset_[j] * place;
  }
  // Interpolation and offsets shorten limbs, and later plans continue from these.
  if (cleans_up_ && person_) {
    person_->FitAboveFeet((*pose)[0]);
    // A provisional frame may be one of which the leader is not known.
    if (frame < next_leader_frame()) {
      solver::KeepApart(model_.skeleton.root, leader_[frame - leader_begin_], (*pose)[0]);
    }
  } else {
    SetBoneLengths(model_.skeleton, bone_lengths_, pose);
  }
}

void LiveSynthesis::Settle(const Poses& frame) {
  follower_.Append(frame.all());
  DropOldFrames();
}

bool LiveSynthesis::NeedsWindow() const { return NextEvaluation().has_value(); }

SynthesisWindow LiveSynthesis::NextWindow() {
  pending_ = NextEvaluation();
  const int join = JoinFrame(*pending_);
  const int sent_end = join > 0 ? timing_.ModelFrameAt(join - 1) + 1 : 0;
  const int settled_end = std::max(std::min(1, sent_end), sent_end - timing_.remade_frames());
  const int known = static_cast<int>(std::ceil(timing_.ToModelFrame(follower_begin_) - kEpsilon));
  const int begin =
      std::max({0, settled_end - timing_.past_frames(), std::min(known, settled_end - 1)});
  const bool is_first = settled_end == 0;
  const int frames =
      is_first ? model_.window_frames
               : std::min(sent_end - begin + timing_.future_frames(), model_.window_frames);
  window_begin_ = begin;
  SynthesisWindow window;
  window.leader = WindowLeader(begin, frames, *pending_, &window.hidden_frames);
  window.labels = WindowLabels(begin, frames, join);
  // As in a clip of a leader who stands: the follower begins where followers of clips begin. With a
  // hidden future, it would begin where they are at any time, which is nearer.
  if (is_first) window.hidden_frames = 0;
  if (!is_first) {
    window.settled = WindowFollower(begin, settled_end, join);
    window.sent = WindowFollower(settled_end, sent_end, join);
    const absl::Span<const Vec3> pose = window.settled[0];
    window.start =
        FollowerStart{window.settled.at(0, model_.skeleton.root), {pose.begin(), pose.end()}};
  } else {
    window.start = request_.start;
    window.partner_direction = request_.partner_direction;
    if (!window.start && !window.partner_direction && model_.partner_direction) {
      window.partner_direction = EstimatePartnerDirection(
          *model_.partner_direction, model_.skeleton, window.leader, window.labels);
    }
  }
  window.options = request_.options;
  window.options.sampling.variety *= kVarietyShare;
  window.options.sampling.first_frame = begin;
  return window;
}

void LiveSynthesis::Accept(const Poses& follower) {
  // Only an engine that violates its contract gets here. Continuing would read past its result.
  if (!pending_ || follower.joint_count() != leader_.joint_count() ||
      follower.frame_count() <= kFramesAfter) {
    std::abort();
  }
  if (evaluation_) skipped_frames_ += *pending_ - timing_.EvaluationAfter(*evaluation_);
  evaluation_ = std::exchange(pending_, std::nullopt);
  plan_ = follower;
  join_frame_ = JoinFrame(*evaluation_);
  plan_begin_ = window_begin_;
  const Poses first(plan_.joint_count(), {plan_[0].begin(), plan_[0].end()});
  bone_lengths_ = MedianBoneLengths(model_.skeleton, first);
  person_.reset();
  if (auto person = solver::BodyModel::Measure(model_.skeleton, first); person.ok()) {
    person_ = *std::move(person);
  }
  KeepOffset();
}

void LiveSynthesis::KeepOffset() {
  offset_.clear();
  const int last = join_frame_ - 1 - follower_begin_;
  if (last < 0) return;
  const std::size_t joints = static_cast<std::size_t>(leader_.joint_count());
  offset_.resize(joints);
  SamplePlan(join_frame_ - 1, absl::MakeSpan(offset_));
  for (std::size_t j = 0; j < joints; ++j) offset_[j] = follower_[last][j] - offset_[j];
}

std::vector<float> LiveSynthesis::WindowLabels(int begin, int frames, int join) const {
  const std::size_t classes = model_.classes.size();
  std::vector<float> labels(static_cast<std::size_t>(frames) * classes);
  for (int t = 0; t < frames; ++t) {
    // Later changes may not be known yet. Those up to the frame that joins are: it is not final.
    const double frame = std::min<double>(timing_.ToCallerFrame(begin + t), join);
    request_.labels.At(frame, labels.data() + static_cast<std::size_t>(t) * classes);
  }
  return labels;
}

Poses LiveSynthesis::WindowLeader(int begin, int frames, int newest, int* hidden) const {
  const int last = newest - leader_begin_;  // the newest frame in `known`
  const Poses known = Part(leader_, 0, std::min(last + 1, leader_.frame_count()));
  Poses leader(frames, known.joint_count());
  std::vector<double> unknown;  // seconds after the newest frame
  for (int t = 0; t < frames; ++t) {
    const double frame = timing_.ToCallerFrame(begin + t) - leader_begin_;
    SampleLinear(known, frame, leader[t]);
    if (frame > last + kEpsilon) unknown.push_back((frame - last) / request_.frame_rate_hz);
  }
  *hidden = static_cast<int>(unknown.size());
  if (unknown.empty()) return leader;
  const Poses resting = ComeToRest(model_.skeleton, known, request_.frame_rate_hz, unknown);
  std::copy(resting.all().begin(), resting.all().end(),
            leader[frames - resting.frame_count()].begin());
  return leader;
}

Poses LiveSynthesis::WindowFollower(int begin, int end, int join) const {
  // A spline must not read what came later.
  const Poses sent = Part(follower_, 0, std::min(join - follower_begin_, follower_.frame_count()));
  Poses settled(end - begin, sent.joint_count());
  for (int t = begin; t < end; ++t) {
    SampleCubic(sent, timing_.ToCallerFrame(t) - follower_begin_, settled[t - begin]);
  }
  return settled;
}

void LiveSynthesis::DropOldFrames() {
  const int keep = next_follower_frame() - timing_.history_frames();
  const auto drop = [keep](Poses* poses, int* begin) {
    const int count = std::clamp(keep - *begin, 0, poses->frame_count());
    poses->DropFront(count);
    *begin += count;
  };
  drop(&leader_, &leader_begin_);
  drop(&follower_, &follower_begin_);
  request_.labels.DropBefore(keep);
}

}  // namespace duet::engine
