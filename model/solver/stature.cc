#include "model/solver/stature.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/motion/filter.h"
#include "model/solver/geometry.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// The times over which corrections of the body's place along the floor and of its height come and
// go. A knee shows a centimetre of height, so that heights follow the legs at once. Seconds.
constexpr double kPlaceSeconds = 0.4, kRiseSeconds = 0.05;
// The weight of following the other hip while a foot swings, against that of an own stand.
constexpr double kFollow = 0.25;
// How far a hip rises or falls against the middle of the pelvis. Metres.
constexpr float kMostRoll = 0.03f;
// The weight of staying, against that of one standing foot.
constexpr double kNear = 0.02;
// Passes over height and roll. More change nothing that can be seen.
constexpr int kRounds = 4;
// The part of a leg's length that it may reach: a knee never locks completely.
constexpr float kReach = 0.998f;
// The body comes down to its standing feet as far as this, in lengths of the leg. A foot that it
// would have to come down further for leaves its place: people who are thrown back lose their stand
// and do not sit down. Captured people's hips are lower in 1 of 1000 frames.
constexpr float kDeepest = 0.7f;
// The least lasting stretch of legs; what lasts: the deviation of a Gaussian, seconds.
constexpr float kLeastStretch = 0.9f;
constexpr double kLastingSeconds = 0.45;

constexpr std::size_t kLegs[] = {0, 1};

class Stature {
 public:
  Stature(const BodyModel& body, const Footing& footing, const Stance& stance, double rate,
          int given, motion::Poses* poses)
      : body_(body),
        footing_(footing),
        stance_(stance),
        rate_(rate),
        given_(given),
        before_(*poses),
        poses_(*poses) {}

  std::vector<Vec3> Run() {
    ShiftAlongFloor();
    std::vector<float> roll(shift_.size());
    for (int round = 0; round < kRounds; ++round) {
      const std::array<std::vector<double>, 2> rises = {Rises(0), Rises(1)};
      for (int t = given_; t < poses_.frame_count(); ++t) {
        const std::size_t at = static_cast<std::size_t>(t);
        const double differ = (rises[0][at] - rises[1][at]) / 2;
        shift_[at].y = static_cast<float>((rises[0][at] + rises[1][at]) / 2);
        roll[at] = std::clamp(roll[at] + static_cast<float>(differ), -kMostRoll, kMostRoll);
        Roll(roll[at], t);
      }
    }
    for (int t = given_; t < poses_.frame_count(); ++t) {
      shift_[static_cast<std::size_t>(t)].y = WithinReach(t);
      for (Vec3& joint : poses_[t]) joint += Shift(t);
    }
    return shift_;
  }

 private:
  Vec3 Hip(std::size_t leg, int t) const { return poses_.at(t, body_.legs()[leg].upper); }
  Vec3 Path(std::size_t leg, int t) const {
    return footing_.paths[leg][static_cast<std::size_t>(t)];
  }
  Vec3 Shift(int t) const { return shift_[static_cast<std::size_t>(t)]; }
  bool Stands(std::size_t leg, int t) const {
    return footing_.standing[leg][static_cast<std::size_t>(t)];
  }

  // The body as it was, with the left hip `roll` higher and the right one lower.
  void Roll(float roll, int t) {
    std::copy(before_[t].begin(), before_[t].end(), poses_[t].begin());
    poses_.at(t, body_.legs()[0].upper).y += roll;
    poses_.at(t, body_.legs()[1].upper).y -= roll;
    body_.Fit(poses_[t]);
  }

  void ShiftAlongFloor() {
    std::vector<double> weights;
    std::vector<Vec3> wishes;
    for (int t = 0; t < poses_.frame_count(); ++t) {
      float weight = 0;
      Vec3 sum;
      for (const std::size_t leg : kLegs) {
        if (!Stands(leg, t)) continue;
        weight += 1;
        sum += Level(Path(leg, t) - stance_.feet[leg][static_cast<std::size_t>(t)]);
      }
      weights.push_back(double{weight});
      wishes.push_back(weight > 0 ? sum / weight : Vec3{});
    }
    shift_ = SmoothShift({rate_, kPlaceSeconds, kNear, given_}, weights, wishes);
  }

  // The rise of one hip at which its leg is as stretched as wanted. While its foot swings, the hip
  // follows the other one.
  std::vector<double> Rises(std::size_t leg) const {
    std::vector<double> weights, wishes;
    for (int t = 0; t < poses_.frame_count(); ++t) {
      const bool own = Stands(leg, t), any = own || Stands(1 - leg, t);
      const std::size_t of = own ? leg : 1 - leg;
      weights.push_back(own ? 1 : any ? kFollow : 0);
      wishes.push_back(any ? RiseAt(of, t, stance_.stretch[of][static_cast<std::size_t>(t)]) : 0);
    }
    return SmoothCorrection({rate_, kRiseSeconds, kNear, given_}, weights, wishes);
  }
  // The rise at which the hip is `length` from the foot's path.
  float RiseAt(std::size_t leg, int t, float length) const {
    const Vec3 way = Path(leg, t) - Hip(leg, t), across = Level(way - Shift(t));
    return way.y + std::sqrt(std::max(0.0f, length * length - Dot(across, across)));
  }

  // The rise, less if a foot that stands would be out of reach.
  float WithinReach(int t) const {
    const float wanted = Shift(t).y;
    float rise = wanted, lower = HUGE_VALF, length = 0;
    for (const std::size_t leg : kLegs) {
      const float own = body_.LegLength(static_cast<int>(leg));
      if (Stands(leg, t)) rise = std::min(rise, RiseAt(leg, t, kReach * own));
      lower = std::min(lower, Path(leg, t).y);
      length += own / 2;
    }
    const float deepest = lower + kDeepest * length - (Hip(0, t).y + Hip(1, t).y) / 2;
    return std::max(rise, std::min(wanted, deepest));
  }

  const BodyModel& body_;
  const Footing& footing_;
  const Stance& stance_;
  double rate_;
  int given_;
  const motion::Poses before_;
  motion::Poses& poses_;
  std::vector<Vec3> shift_;
};

}  // namespace

Stance MeasureStance(const BodyModel& body, const motion::Poses& poses) {
  Stance stance;
  for (const std::size_t leg : kLegs) {
    const body::Limb& limb = body.legs()[leg];
    for (int t = 0; t < poses.frame_count(); ++t) {
      stance.feet[leg].push_back(poses.at(t, limb.end));
      stance.stretch[leg].push_back(Distance(poses.at(t, limb.upper), poses.at(t, limb.end)));
    }
  }
  return stance;
}

void StretchLegs(const BodyModel& body, double frame_rate_hz, Stance* stance) {
  for (const std::size_t leg : kLegs) {
    std::vector<float>& stretch = stance->stretch[leg];
    motion::Poses lasting(static_cast<int>(stretch.size()), 1);
    for (std::size_t t = 0; t < stretch.size(); ++t) lasting.all()[t].y = stretch[t];
    lasting = motion::GaussianFilter(lasting, kLastingSeconds * frame_rate_hz);
    const float least = kLeastStretch * body.LegLength(static_cast<int>(leg));
    for (std::size_t t = 0; t < stretch.size(); ++t) {
      stretch[t] += std::max(0.0f, least - lasting.all()[t].y);
    }
  }
}

std::vector<Vec3> StandOnFeet(const BodyModel& body, const Footing& footing, const Stance& stance,
                              double frame_rate_hz, int given, motion::Poses* poses) {
  return Stature(body, footing, stance, frame_rate_hz, given, poses).Run();
}

}  // namespace duet::solver
