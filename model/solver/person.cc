#include "model/solver/person.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/body/limbs.h"
#include "model/motion/feet.h"
#include "model/motion/filter.h"
#include "model/solver/body_model.h"
#include "model/solver/footing.h"
#include "model/solver/stature.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// Bends of nearly straight limbs point anywhere in noise. Seconds, standard deviation.
constexpr double kBendSeconds = 0.1;
constexpr double kStandingShare = 0.25;

constexpr std::size_t kLegs[] = {0, 1};

// One person of a capture. The body's place is corrected so that standing feet are where they stand
// and legs are as stretched as in the capture; the pelvis rolls where the two legs disagree.
class Solver {
 public:
  Solver(const BodyModel& body, motion::Poses captured, double rate, double floor)
      : body_(body), rate_(rate), fitted_(std::move(captured)) {
    for (int t = 0; t < frames(); ++t) body_.Fit(fitted_[t]);
    stance_ = MeasureStance(body_, fitted_);
    footing_ = PlanFooting(stance_.feet, rate_, floor);
  }

  motion::Poses Run() {
    shift_ = StandOnFeet(body_, footing_, stance_, rate_, 0, &fitted_);
    return PlaceLegs();
  }

 private:
  int frames() const { return fitted_.frame_count(); }
  const body::Limb& Leg(std::size_t leg) const { return body_.legs()[leg]; }
  // The foot as captured, and on its planned path.
  Vec3 Foot(std::size_t leg, int t) const { return stance_.feet[leg][static_cast<std::size_t>(t)]; }
  Vec3 Path(std::size_t leg, int t) const {
    return footing_.paths[leg][static_cast<std::size_t>(t)];
  }
  Vec3 Shift(int t) const { return shift_[static_cast<std::size_t>(t)]; }
  bool Stands(std::size_t leg, int t) const {
    return footing_.standing[leg][static_cast<std::size_t>(t)];
  }

  motion::Poses PlaceLegs() const {
    motion::Poses solved = fitted_;
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

  const BodyModel& body_;
  double rate_;
  motion::Poses fitted_;  // the body, before its legs are placed
  Stance stance_;         // of the body where the capture has it
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
  return Solver(*body, std::move(lifted), frame_rate_hz, floor).Run();
}

}  // namespace duet::solver
