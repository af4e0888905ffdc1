#include "model/cleanup/footsteps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "model/cleanup/directions.h"
#include "model/cleanup/low_pass.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Track = std::vector<Vec3>;

// Removes the network's jitter before steps are found.
constexpr double kSmoothSeconds = 0.08;
// A foot that lands stands where its track is in this time, on average.
constexpr double kStandSeconds = 0.4;
// The heights between which a standing foot is left above the floor, metres.
constexpr float kStandsBelow = -0.005f, kStandsAbove = 0.015f;
constexpr double kHeightSmoothSeconds = 0.03;
// A foot that stands for kMomentSeconds or less comes down and rises at up to this speed, m/s.
constexpr float kFastestSink = 0.6f;
constexpr double kMomentSeconds = 0.2;
// The height of a step, metres, and what a metre of way adds to it, up to the highest.
constexpr float kLift = 0.02f, kLiftPerMetre = 0.15f, kHighestLift = 0.06f;
// The body's part in the way of its feet, and how smoothly it follows.
constexpr float kBodyShare = 0.25f;
constexpr double kBodySmoothSeconds = 0.2;
// The longest reach of a leg, in lengths of the leg, and how far the body sinks for it, metres.
constexpr float kLongestReach = 0.99f, kDeepestSink = 0.15f;
// It does not sink until its hips are lower above the foot than this, in lengths of the leg.
constexpr float kLowestHips = 0.8f;
constexpr double kSinkSmoothSeconds = 0.1;
// A knee that is this far from the line of its leg has a direction, metres.
constexpr float kClearBend = 0.06f;
constexpr double kKneeSmoothSeconds = 0.1;

float Float(double value) { return static_cast<float>(value); }

// One foot: its track, and where the plan has it.
class Foot {
 public:
  Foot(const Track& track, float floor, const FootstepOptions& options, const Timing& timing)
      : track_(track),
        smooth_(LowPass(track, timing.Frames(kSmoothSeconds))),
        floor_(floor),
        options_(options),
        timing_(timing) {
    path_.places.assign(track.begin(), track.begin() + timing.settled);
    path_.stands.assign(static_cast<std::size_t>(timing.settled), false);
    Begin();
  }

  // Whether it steps, or has landed in this frame.
  bool Moves(int frame) const { return steps_ || stands_since_ == frame; }
  // How far the track is from the place where the foot stands, along the floor.
  float Stretch(int frame) const { return Norm(Level(At(track_, frame) - place_)); }

  // Whether the track itself steps.
  bool TrackSteps(int frame) const {
    return Speed(frame) > Float(options_.fast_metres_per_second) ||
           Height(frame) > Float(options_.high_metres);
  }
  bool InTheAir(int frame) const { return Height(frame) > Float(options_.high_metres); }

  // How urgently a standing foot must step; 0: not at all.
  float Urgency(int frame) const {
    if (steps_) return 0;
    if (InTheAir(frame)) return 1 + Stretch(frame);
    const bool rested = frame - stands_since_ >= timing_.Frames(options_.shortest_stand_seconds);
    const int ahead = static_cast<int>(std::lround(timing_.Frames(timing_.anticipation_seconds)));
    const float stretch = std::max(Stretch(frame), Stretch(frame + ahead));
    const float enough = Float(options_.farthest_metres) * (TrackSteps(frame) ? 0.5f : 1.0f);
    return rested && stretch > enough ? stretch : 0;
  }

  void Land(int frame) {
    if (!steps_ || frame < end_) return;
    steps_ = false;
    place_ = Level(At(track_, end_) + to_);
    stands_since_ = frame;
  }

  void StartStep(int frame) {
    from_ = Level(place_ - At(track_, frame - 1));
    Aim(frame - 1, TrackSteps(frame) ? Landing(frame, frame) : frame + StepFrames());
  }

  void Place(int frame) {
    const Vec3 track = At(track_, frame);
    Vec3 at = steps_ ? Level(track) + Offset(frame) : place_;
    at.y = steps_ ? std::max(track.y, floor_ + LiftAt(frame)) : track.y;
    path_.places.push_back(at);
    path_.stands.push_back(!steps_);
  }

  // The path, with standing feet on the floor.
  FootPath Finish() {
    std::vector<float> sink;
    for (std::size_t t = 0; t < path_.places.size(); ++t) {
      const float height = path_.places[t].y - floor_;
      const float wanted = std::clamp(height, kStandsBelow, kStandsAbove) - height;
      sink.push_back(path_.stands[t] ? std::max(wanted, -DeepestSink(t)) : 0);
    }
    sink = LowPass(sink, timing_.Frames(kHeightSmoothSeconds));
    for (std::size_t t = static_cast<std::size_t>(timing_.settled); t < sink.size(); ++t) {
      path_.places[t].y += sink[t];
    }
    return std::move(path_);
  }

 private:
  // The state in which the settled frames leave the foot.
  void Begin() {
    const int last = timing_.settled - 1;
    place_ = Level(At(track_, std::max(0, last)));
    if (last < 0) return;
    const bool high = Height(last) > Float(options_.high_metres);
    // The last frame before the foot began to move, or to stand.
    const int begin = timing_.continues_steps ? LastOther(last) : last;
    const bool over = last - begin >= StepFrames() && Height(last) < Float(options_.low_metres);
    if (high || (Moved(last) && !over)) {
      from_ = {};
      Aim(last, Landing(begin + 1, last + 1));
      lift_begin_ = begin;
    } else if (Moved(last)) {
      stands_since_ = last;
    } else if (timing_.continues_steps && begin > 0) {
      stands_since_ = begin + 1;
    }
  }

  // Whether the settled foot moved to get to a frame.
  bool Moved(int frame) const {
    return frame > 0 &&
           Distance(At(track_, frame), At(track_, frame - 1)) * Float(timing_.frame_rate_hz) >
               Float(options_.slow_metres_per_second);
  }
  // The last settled frame in which the foot did not do what it does in frame `last`; or 0.
  int LastOther(int last) const {
    int frame = last;
    while (frame > 0 && Moved(frame) == Moved(last)) --frame;
    return frame;
  }

  void Aim(int begin, int end) {
    steps_ = true;
    begin_ = lift_begin_ = begin;
    end_ = end;
    const Vec3 aim = MeanFrom(end);
    to_ = end <= last() ? Level(aim - At(track_, end)) : Vec3{};
    way_ = Norm(Level(aim - At(track_, begin)) - from_);
  }

  int last() const { return static_cast<int>(track_.size()) - 1; }
  int StepFrames() const {
    return std::max(2, static_cast<int>(std::lround(timing_.Frames(options_.step_seconds))));
  }

  Vec3 At(const Track& track, int frame) const {
    return track[static_cast<std::size_t>(std::clamp(frame, 0, last()))];
  }
  float Height(int frame) const { return At(smooth_, frame).y - floor_; }
  float Speed(int frame) const {
    return Distance(At(smooth_, frame + 1), At(smooth_, frame - 1)) * Float(timing_.frame_rate_hz) /
           2;
  }

  // How far a foot may come down in a frame in which it stands. Where it stands for a moment, it
  // also needs time to get there from its last step, and back to its next one.
  float DeepestSink(std::size_t frame) const {
    const std::size_t settled = static_cast<std::size_t>(timing_.settled);
    std::size_t begin = frame, end = frame + 1;
    while (begin > settled && path_.stands[begin - 1]) --begin;
    while (end < path_.stands.size() && path_.stands[end]) ++end;
    const bool between_steps = begin > settled && end < path_.stands.size();
    if (!between_steps ||
        Float(static_cast<double>(end - begin)) > timing_.Frames(kMomentSeconds)) {
      return std::numeric_limits<float>::max();
    }
    const std::size_t frames = std::min(frame + 1 - begin, end - frame);
    return kFastestSink * Float(static_cast<double>(frames) / timing_.frame_rate_hz);
  }

  // The frame, `first` or later, in which the track comes to rest after a step from `frame` on, or
  // in which the step ends if it goes on; while the foot is in the air, the one in which it comes
  // down. Beyond the last if it does not.
  int Landing(int frame, int first) const {
    const int longest = std::max(first, frame + StepFrames());
    for (int t = std::max(first, frame + StepFrames() / 2); t <= last(); ++t) {
      const bool rests = Speed(t) < Float(options_.slow_metres_per_second);
      if (Height(t) < Float(options_.low_metres) && (rests || t >= longest)) return t;
    }
    return std::max(last() + 1, longest);
  }

  Vec3 MeanFrom(int frame) const {
    const int count = std::max(1, static_cast<int>(timing_.Frames(kStandSeconds)));
    Vec3 sum;
    int frames = 0;
    for (int t = frame; t < frame + count && (frames == 0 || t <= last()); ++t, ++frames) {
      sum += At(track_, t);
    }
    return sum / Float(frames);
  }

  // How far a step has come, 0 to 1.
  float Progress(int frame, int frames) const {
    return SmoothStep((frame - begin_) / Float(std::max(1, frames)));
  }
  // From the track to the foot: what is left of the way from its last place, and what there is of
  // the way to its next one.
  Vec3 Offset(int frame) const {
    const int whole = end_ - begin_;
    return from_ * (1 - Progress(frame, std::min(whole, StepFrames()))) +
           to_ * Progress(frame, whole);
  }
  float LiftAt(int frame) const {
    const float at = Float(frame - lift_begin_) / Float(std::max(1, end_ - lift_begin_));
    const float lift = std::min(kHighestLift, kLift + kLiftPerMetre * way_);
    return lift * 4 * std::clamp(at * (1 - at), 0.0f, 0.25f);
  }

  const Track& track_;
  const Track smooth_;
  const float floor_;
  const FootstepOptions& options_;
  const Timing& timing_;

  bool steps_ = false;
  Vec3 place_;  // while it stands; at height 0
  int stands_since_ = std::numeric_limits<int>::min() / 2;
  int begin_ = 0, end_ = 0;  // of the step, or of the part of it that is planned
  int lift_begin_ = 0;       // of the whole step
  Vec3 from_, to_;           // the foot's offset from its track at both ends of the step
  float way_ = 0;            // metres
  FootPath path_;
};

// Starts the most urgent step. A second foot steps at the same time only in a jump, or if it would
// be stretched too far.
void StartSteps(int frame, const FootstepOptions& options, std::vector<Foot>* feet) {
  std::vector<Foot*> order;
  for (Foot& foot : *feet) order.push_back(&foot);
  std::sort(order.begin(), order.end(), [frame](const Foot* a, const Foot* b) {
    return a->Urgency(frame) > b->Urgency(frame);
  });
  const bool jump = std::all_of(feet->begin(), feet->end(),
                                [frame](const Foot& foot) { return foot.InTheAir(frame); });
  for (Foot* foot : order) {
    if (foot->Urgency(frame) == 0) continue;
    const bool alone = std::none_of(feet->begin(), feet->end(),
                                    [frame](const Foot& other) { return other.Moves(frame); });
    if (alone || jump || foot->Stretch(frame) > Float(options.stretched_metres)) {
      foot->StartStep(frame);
    }
  }
}

// The directions in which a knee points, smooth over time. A leg that is nearly straight points
// forwards: its knee may not change sides when the leg bends. Shapes: returns [frames].
std::vector<Vec3> KneeBends(const motion::Skeleton& skeleton, const body::Limb& leg,
                            const Timing& timing, const motion::Poses& poses) {
  std::vector<Vec3> bends;
  for (int t = 0; t < poses.frame_count(); ++t) {
    Vec3 bend = BendOf(leg, poses[t]);
    if (skeleton.hips) {
      bend += body::Facing(*skeleton.hips, poses[t]) * std::max(0.0f, kClearBend - Norm(bend));
    }
    const float length = Norm(bend);
    bends.push_back(length > 0 ? bend / length : bend);
  }
  return LowPass(bends, timing.Frames(kKneeSmoothSeconds));
}

// How far the body must sink for its legs to reach their feet.
float Sink(const body::Body& body, const std::vector<FootPath>& paths, std::size_t frame,
           absl::Span<const Vec3> pose) {
  float sink = 0;
  for (std::size_t leg = 0; leg < paths.size(); ++leg) {
    const body::Limb& limb = body.legs[leg];
    const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
    const float length = LengthOf(limb, pose);
    const Vec3 way = paths[leg].places[frame] - at(limb.upper);
    const float across = Norm(Level(way)), reach = kLongestReach * length;
    const float deepest = across < reach ? std::sqrt(reach * reach - across * across) : 0;
    const float room = std::max(0.0f, -way.y - kLowestHips * length);
    sink = std::max(sink, std::min({kDeepestSink, room, -way.y - deepest}));
  }
  return sink;
}

// The corrections of the whole body along the floor, with its feet. Shapes: returns [frames].
std::vector<Vec3> BodyShifts(const body::Body& body, const std::vector<FootPath>& paths,
                             const Timing& timing, const motion::Poses& poses) {
  std::vector<Vec3> shifts(static_cast<std::size_t>(poses.frame_count()));
  for (int t = timing.settled; t < poses.frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    for (std::size_t leg = 0; leg < paths.size(); ++leg) {
      shifts[at] += Level(paths[leg].places[at] - poses.at(t, body.legs[leg].end)) * kBodyShare /
                    Float(static_cast<double>(paths.size()));
    }
  }
  return LowPass(shifts, timing.Frames(kBodySmoothSeconds));
}

// Lowers the body in every frame so far that its legs reach their feet.
void SinkToFeet(const body::Body& body, const std::vector<FootPath>& paths, const Timing& timing,
                motion::Poses* poses) {
  std::vector<float> sinks(static_cast<std::size_t>(poses->frame_count()));
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    sinks[at] = Sink(body, paths, at, (*poses)[t]);
  }
  const double smooth = timing.Frames(kSinkSmoothSeconds);
  sinks = LowPass(MostAround(sinks, static_cast<int>(std::lround(2 * smooth))), smooth);
  // What the settled frames lack must not come at once.
  const float lacks = timing.settled > 0 ? sinks[static_cast<std::size_t>(timing.settled - 1)] : 0;
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const float sink = sinks[static_cast<std::size_t>(t)] - lacks * (1 - EaseIn(timing, t));
    for (Vec3& joint : (*poses)[t]) joint.y -= sink;
  }
}

}  // namespace

std::vector<FootPath> PlanFootsteps(const std::vector<Track>& tracks, float floor,
                                    const FootstepOptions& options, const Timing& timing) {
  std::vector<Foot> feet;
  feet.reserve(tracks.size());
  for (const Track& track : tracks) feet.emplace_back(track, floor, options, timing);
  const int frames = tracks.empty() ? 0 : static_cast<int>(tracks.front().size());
  for (int t = timing.settled; t < frames; ++t) {
    for (Foot& foot : feet) foot.Land(t);
    StartSteps(t, options, &feet);
    for (Foot& foot : feet) foot.Place(t);
  }
  std::vector<FootPath> paths;
  for (Foot& foot : feet) paths.push_back(foot.Finish());
  return paths;
}

void WalkInSteps(const motion::Skeleton& skeleton, const body::Body& body, float floor,
                 const FootstepOptions& options, const Timing& timing, motion::Poses* poses) {
  if (body.legs.empty()) return;
  std::vector<Track> tracks;
  for (const body::Limb& leg : body.legs) {
    tracks.emplace_back();
    for (int t = 0; t < poses->frame_count(); ++t) tracks.back().push_back(poses->at(t, leg.end));
  }
  const std::vector<FootPath> paths = PlanFootsteps(tracks, floor, options, timing);
  const std::vector<Vec3> shifts = BodyShifts(body, paths, timing, *poses);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    for (Vec3& joint : (*poses)[t])
      joint += shifts[static_cast<std::size_t>(t)] * EaseIn(timing, t);
  }
  SinkToFeet(body, paths, timing, poses);
  for (std::size_t leg = 0; leg < paths.size(); ++leg) {
    const std::vector<Vec3> bends = KneeBends(skeleton, body.legs[leg], timing, *poses);
    for (int t = timing.settled; t < poses->frame_count(); ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      ReachBent(body.legs[leg], paths[leg].places[at], bends[at], (*poses)[t]);
    }
  }
}

}  // namespace duet::cleanup
