#include "model/engine/clip_synthesis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>

#include "model/engine/windows.h"
#include "model/motion/limb_lengths.h"
#include "model/motion/resample.h"
#include "model/solver/follower.h"

namespace duet::engine {
namespace {

// Frames of a spline before and after the one that a time falls in.
constexpr int kFramesBefore = 1;
constexpr int kFramesAfter = 2;
// A window prepares for pins that come this soon after it.
constexpr double kPinAheadSeconds = 1;
// The frames nearer to a pin than this move as the pin has them.
constexpr double kNearPinSeconds = 1;
// Frames. A time this near to a frame of the model is that frame.
constexpr double kEpsilon = 1e-6;

}  // namespace

ClipSynthesis::ClipSynthesis(ModelDescription model, ClipRequest request)
    : model_(std::move(model)),
      request_(std::move(request)),
      cross_fade_(model_.skeleton),
      frame_count_(request_.leader.frame_count()),
      model_frames_per_frame_(model_.frame_rate_hz / request_.frame_rate_hz),
      plan_(PlanWindows(
          motion::ResampledFrameCount(frame_count_, request_.frame_rate_hz, model_.frame_rate_hz),
          model_.window_frames, WindowOverlap(model_))),
      state_(model_.skeleton.joint_count()),
      body_(body::FindBody(model_.skeleton)),
      cleans_up_(request_.options.clean_up.value_or(model_.cleaned_up_by_default())),
      pin_distances_(request_.pins.size()) {
  if (body::PairMeter::CanMeasure(model_.skeleton, body_)) {
    meter_.emplace(model_.skeleton, body_, request_.frame_rate_hz);
  }
}

SynthesisWindow ClipSynthesis::NextWindow() const {
  const std::size_t classes = model_.classes.size();
  const int index = state_.window_count();
  const int first = NextWindowStart();
  SynthesisWindow window;
  window.leader = LeaderAt(first, first + plan_.length);
  window.labels.resize(static_cast<std::size_t>(plan_.length) * classes);
  for (int t = 0; t < plan_.length; ++t) {
    request_.labels.At(ToCallerFrame(first + t),
                       window.labels.data() + static_cast<std::size_t>(t) * classes);
  }
  if (index == 0) {
    window.start = request_.start;
  } else {
    ContinueFrom(state_, first, model_, &window);
  }
  // The characters move, so in later windows the follower's position gives the direction.
  if (index == 0 || !window.start) window.partner_direction = request_.partner_direction;
  if (!window.start && !window.partner_direction && model_.partner_direction) {
    window.partner_direction = EstimatePartnerDirection(*model_.partner_direction, model_.skeleton,
                                                        window.leader, window.labels);
  }
  window.pins = PinsOfWindow(first);
  window.options = request_.options;
  window.options.sampling.seed = WindowSeed(request_.options.sampling.seed, index);
  return window;
}

motion::Poses ClipSynthesis::Accept(const motion::Poses& follower) {
  // Only an engine that violates its contract gets here. Continuing would read past its result.
  if (!HasNextWindow() || follower.frame_count() != plan_.length ||
      follower.joint_count() != model_.skeleton.joint_count()) {
    std::abort();
  }
  state_.Add(NextWindowStart(), follower, cross_fade_);
  if (HasNextWindow() && ContinuesFromSettledFrames(model_)) {
    state_.DropFrom(SettledEnd());
  }
  motion::Poses frames = TakeFinalFrames();
  DropFrames();
  Measure(frames);
  return frames;
}

int ClipSynthesis::SettledEnd() const {
  // A window that reached a pin settles it: the next one would have to reach it anew.
  if (!request_.pins.empty()) return state_.end() - model_.lookahead_frames;
  return NextWindowStart() + SettledOverlap(model_.window_frames);
}

motion::Poses ClipSynthesis::LeaderAt(int begin, int end) const {
  motion::Poses leader(end - begin, model_.skeleton.joint_count());
  for (int t = begin; t < end; ++t) {
    SampleLinear(request_.leader, ToCallerFrame(t), leader[t - begin]);
  }
  return leader;
}

motion::Pins ClipSynthesis::PinsOfWindow(int first) const {
  const double ahead = kPinAheadSeconds * model_.frame_rate_hz;
  motion::Pins pins;
  for (motion::Pin pin : request_.pins) {
    pin.frame = ToModelFrame(pin.frame) - first;
    if (pin.frame >= 0 && pin.frame < plan_.length + ahead) pins.push_back(pin);
  }
  return pins;
}

void ClipSynthesis::Measure(const motion::Poses& frames) {
  const int first = next_frame_ - frames.frame_count();
  for (int t = 0; meter_ && t < frames.frame_count(); ++t) {
    grade_.Add(meter_->Add(request_.leader[first + t], frames[t]));
  }
  for (std::size_t i = 0; i < request_.pins.size(); ++i) {
    const motion::Pin& pin = request_.pins[i];
    const int frame = static_cast<int>(pin.frame) - first;
    if (frame < 0 || frame >= frames.frame_count()) continue;
    pin_distances_[i] = Distance(frames.at(frame, pin.joint), pin.position);
  }
}

std::optional<body::Grade> ClipSynthesis::grade() const {
  if (HasNextWindow() || !meter_) return std::nullopt;
  return grade_.Get();
}

motion::Poses ClipSynthesis::TakeFinalFrames() {
  const int joints = model_.skeleton.joint_count();
  // The next window may change its first frame and all that follow.
  const int final_end = HasNextWindow() ? NextWindowStart() : std::numeric_limits<int>::max();
  motion::Poses frames(0, joints), pose(1, joints);
  for (; next_frame_ < frame_count_; ++next_frame_) {
    const double at = ToModelFrame(next_frame_);
    if (static_cast<int>(at) >= final_end - kFramesAfter) break;
    SampleCubic(state_.follower(), at - state_.begin(), pose[0]);
    KeepBody(at - state_.begin(), &pose);
    frames.Append(pose.all());
  }
  return frames;
}

void ClipSynthesis::KeepBody(double at, motion::Poses* pose) {
  const motion::Poses& follower = state_.follower();
  if (!cleans_up_) return;
  const int before = static_cast<int>(at);
  if (bone_lengths_.empty()) {
    const motion::Poses first = motion::Part(follower, before, 1);
    bone_lengths_ = motion::MedianBoneLengths(model_.skeleton, first);
    if (auto person = solver::BodyModel::Measure(model_.skeleton, first); person.ok()) {
      person_ = *std::move(person);
    }
  }
  if (at - before < kEpsilon || IsNearPin(next_frame_)) return;
  const int after = std::min(before + 1, follower.frame_count() - 1);
  if (!person_) return motion::SetBoneLengths(model_.skeleton, bone_lengths_, pose);
  solver::KeepFeetBetween(body_, follower[before], follower[after], (*pose)[0]);
  person_->FitAboveFeet((*pose)[0]);
}

bool ClipSynthesis::IsNearPin(int frame) const {
  const double near = kNearPinSeconds * request_.frame_rate_hz;
  return std::any_of(request_.pins.begin(), request_.pins.end(),
                     [&](const motion::Pin& pin) { return std::abs(pin.frame - frame) < near; });
}

void ClipSynthesis::DropFrames() {
  if (!HasNextWindow()) return state_.DropBefore(state_.end());
  const int spline = static_cast<int>(ToModelFrame(next_frame_)) - kFramesBefore;
  state_.DropBefore(std::min(spline, NextWindowStart()));
}

}  // namespace duet::engine
