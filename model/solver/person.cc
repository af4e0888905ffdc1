#include "model/solver/person.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/body/limbs.h"
#include "model/motion/feet.h"
#include "model/motion/filter.h"
#include "model/solver/body_model.h"
#include "model/solver/feet.h"
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
constexpr double kMostRoll = 0.03;
// The weight of staying at the captured place, against that of one standing foot.
constexpr double kNear = 0.02;
// Passes over place and height. More change nothing that can be seen.
constexpr int kRounds = 4;
// The part of a leg's length that it may reach: a knee never locks completely.
constexpr float kReach = 0.998f;
// Bends of nearly straight limbs point anywhere in noise. Seconds, standard deviation.
constexpr double kBendSeconds = 0.1;
constexpr double kStandingShare = 0.25;

std::array<FootPath, 2> FeetOf(const BodyModel& body, const motion::Poses& person) {
  std::array<FootPath, 2> feet;
  for (std::size_t leg = 0; leg < 2; ++leg) {
    for (int t = 0; t < person.frame_count(); ++t) {
      feet[leg].push_back(person.at(t, body.legs()[leg].end));
    }
  }
  return feet;
}

constexpr std::size_t kLegs[] = {0, 1};

// One person of a capture. The body's place is corrected so that standing feet are where they stand
// and legs are as stretched as in the capture; the pelvis rolls where the two legs disagree.
class Solver {
 public:
  Solver(BodyModel body, const motion::Poses& captured, double rate, double floor)
      : body_(std::move(body)), rate_(rate), captured_(captured) {
    Fit(std::vector<double>(static_cast<std::size_t>(frames()), 0));
    feet_ = FeetOf(body_, fitted_);
    for (const std::size_t leg : kLegs) {
      for (int t = 0; t < frames(); ++t)
        stretch_[leg].push_back(Distance(Hip(leg, t), Foot(leg, t)));
    }
    footing_ = PlanFooting(feet_, rate_, floor);
    shift_.assign(static_cast<std::size_t>(frames()), Vec3{});
  }

  motion::Poses Run() {
    std::vector<double> roll(shift_.size(), 0);
    for (int round = 0; round < kRounds; ++round) {
      ShiftAlongFloor(&Vec3::x);
      ShiftAlongFloor(&Vec3::z);
      const std::array<std::vector<double>, 2> rises = {Rise(0), Rise(1)};
      for (std::size_t t = 0; t < shift_.size(); ++t) {
        shift_[t].y = static_cast<float>((rises[0][t] + rises[1][t]) / 2);
        roll[t] = std::clamp(roll[t] + (rises[0][t] - rises[1][t]) / 2, -kMostRoll, kMostRoll);
      }
      Fit(roll);
    }
    StayWithinReach();
    return PlaceLegs();
  }

 private:
  int frames() const { return captured_.frame_count(); }
  const body::Limb& Leg(std::size_t leg) const { return body_.legs()[leg]; }
  // The foot as captured, and on its planned path.
  Vec3 Foot(std::size_t leg, int t) const { return feet_[leg][static_cast<std::size_t>(t)]; }
  Vec3 Path(std::size_t leg, int t) const {
    return footing_.paths[leg][static_cast<std::size_t>(t)];
  }
  Vec3 Hip(std::size_t leg, int t) const { return fitted_.at(t, Leg(leg).upper); }
  Vec3 Shift(int t) const { return shift_[static_cast<std::size_t>(t)]; }
  bool Stands(std::size_t leg, int t) const {
    return footing_.standing[leg][static_cast<std::size_t>(t)];
  }

  // Fits the body to the capture, with the left hip `roll` higher and the right one lower.
  void Fit(const std::vector<double>& roll) {
    fitted_ = captured_;
    for (int t = 0; t < frames(); ++t) {
      const float up = static_cast<float>(roll[static_cast<std::size_t>(t)]);
      fitted_.at(t, Leg(0).upper).y += up;
      fitted_.at(t, Leg(1).upper).y -= up;
      body_.Fit(fitted_[t]);
    }
  }

  // The body goes where its standing feet went.
  void ShiftAlongFloor(float Vec3::*coordinate) {
    std::vector<double> weights, wishes;
    for (int t = 0; t < frames(); ++t) {
      double weight = 0, sum = 0;
      for (const std::size_t leg : kLegs) {
        if (!Stands(leg, t)) continue;
        weight += 1;
        sum += Path(leg, t).*coordinate - Foot(leg, t).*coordinate;
      }
      weights.push_back(weight);
      wishes.push_back(weight > 0 ? sum / weight : 0);
    }
    const std::vector<double> values =
        SmoothCorrection({rate_, kPlaceSeconds, kNear}, weights, wishes);
    for (std::size_t t = 0; t < values.size(); ++t) {
      shift_[t].*coordinate = static_cast<float>(values[t]);
    }
  }

  // The rise of one hip at which its leg is as stretched as in the capture. While its foot swings,
  // the hip follows the other one.
  std::vector<double> Rise(std::size_t leg) const {
    std::vector<double> weights, wishes;
    for (int t = 0; t < frames(); ++t) {
      const bool own = Stands(leg, t);
      const bool any = own || Stands(1 - leg, t);
      weights.push_back(own ? 1 : any ? kFollow : 0);
      wishes.push_back(any ? RiseAt(own ? leg : 1 - leg, t, StretchOf(own ? leg : 1 - leg, t)) : 0);
    }
    return SmoothCorrection({rate_, kRiseSeconds, kNear}, weights, wishes);
  }
  double StretchOf(std::size_t leg, int t) const {
    return stretch_[leg][static_cast<std::size_t>(t)];
  }
  // The rise at which the hip is `length` from the foot's path.
  double RiseAt(std::size_t leg, int t, double length) const {
    const Vec3 hip = Hip(leg, t) + Shift(t), foot = Path(leg, t);
    const double across = std::hypot(hip.x - foot.x, hip.z - foot.z);
    return foot.y + std::sqrt(std::max(0.0, length * length - across * across)) - Hip(leg, t).y;
  }

  // A foot that stands is never out of reach: the body comes down instead.
  void StayWithinReach() {
    for (int t = 0; t < frames(); ++t) {
      for (const std::size_t leg : kLegs) {
        if (!Stands(leg, t)) continue;
        const double reach = kReach * body_.LegLength(static_cast<int>(leg));
        float& rise = shift_[static_cast<std::size_t>(t)].y;
        rise = std::min(rise, static_cast<float>(RiseAt(leg, t, reach)));
      }
    }
  }

  motion::Poses PlaceLegs() const {
    motion::Poses solved = fitted_;
    for (int t = 0; t < frames(); ++t) {
      for (Vec3& joint : solved[t]) joint += Shift(t);
    }
    for (const std::size_t leg : kLegs) {
      const motion::Poses bends = SmoothBends(leg);
      const FootPath path = SwingWithBody(leg);
      for (int t = 0; t < frames(); ++t) {
        body::ReachBent(Leg(leg), path[static_cast<std::size_t>(t)], bends.at(t, 0), solved[t]);
      }
    }
    return solved;
  }
  // A swinging foot follows the body, so that its knee keeps its bend, and meets the stands before
  // and after.
  FootPath SwingWithBody(std::size_t leg) const {
    FootPath path;
    const auto carried = [&](int t) { return Foot(leg, t) + Shift(t); };
    int before = -1, after = -1;
    for (int t = 0; t < frames(); ++t) {
      if (Stands(leg, t)) before = t;
      while (after < t || (after < frames() && !Stands(leg, after))) ++after;
      const bool begins = before >= 0, ends = after < frames();
      const Vec3 last = begins ? Path(leg, before) - carried(before) : Vec3{};
      const Vec3 next = ends ? Path(leg, after) - carried(after) : last;
      const float u = begins && ends && after > before
                          ? static_cast<float>(t - before) / static_cast<float>(after - before)
                          : 0;
      path.push_back(carried(t) + Lerp(begins ? last : next, next, u * u * (3 - 2 * u)));
    }
    return path;
  }
  motion::Poses SmoothBends(std::size_t leg) const {
    motion::Poses bends(frames(), 1);
    for (int t = 0; t < frames(); ++t) bends.at(t, 0) = body::BendOf(Leg(leg), fitted_[t]);
    return motion::GaussianFilter(bends, kBendSeconds * rate_);
  }

  BodyModel body_;
  double rate_;
  const motion::Poses& captured_;
  motion::Poses fitted_;                        // the body where the capture has it
  std::array<FootPath, 2> feet_;                // as captured
  std::array<std::vector<double>, 2> stretch_;  // from hip to foot, as captured
  Footing footing_;
  std::vector<Vec3> shift_;
};

}  // namespace

double StandingHeight(const motion::Skeleton& skeleton, const motion::Poses& person) {
  std::vector<float> heights = motion::LowerFoot(*skeleton.feet, person);
  const auto quartile = heights.begin() + static_cast<std::ptrdiff_t>(
                                              kStandingShare * static_cast<double>(heights.size()));
  std::nth_element(heights.begin(), quartile, heights.end());
  return *quartile;
}

absl::StatusOr<motion::Poses> SolvePerson(const motion::Skeleton& skeleton,
                                          const motion::Poses& person, double frame_rate_hz,
                                          double floor) {
  absl::StatusOr<BodyModel> body = BodyModel::Measure(skeleton, person);
  if (!body.ok()) return body.status();
  const auto lift = static_cast<float>(floor - StandingHeight(skeleton, person));
  motion::Poses lifted = person;
  for (Vec3& joint : lifted.all()) joint.y += lift;
  return Solver(*std::move(body), lifted, frame_rate_hz, floor).Run();
}

}  // namespace duet::solver
