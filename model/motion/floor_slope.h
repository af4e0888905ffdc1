#ifndef DUET_MODEL_MOTION_FLOOR_SLOPE_H_
#define DUET_MODEL_MOTION_FLOOR_SLOPE_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/motion/slope.h"

namespace duet::motion {

// The floor's slope from the places where feet rest: a plane is fitted to them. Each foot of each
// person has its own height above the plane, because captures place left and right feet, and the
// feet of two people, at different heights. So only a foot that rests in several places is
// evidence, and only for the slope along them. The error grows with the scatter about the plane:
// depth cameras scatter, and bend, a floor.
class FloorEvidence {
 public:
  // Requires feet and poses in the skeleton's joint order.
  void Add(const Skeleton& skeleton, const Clip& person);
  // The slope of the floor's normal. Absent if no foot rests in several places.
  std::optional<SlopeEstimate> Estimate() const;
  // How many; a place counts once for each foot.
  int place_count() const { return static_cast<int>(places_.size()); }

 private:
  // Where a foot rests.
  struct Place {
    std::size_t foot = 0;
    double x = 0, y = 0, z = 0;
    double weight = 1;
  };

  void AddFoot(const Clip& person, int joint);
  std::vector<Place> Centred(const std::vector<Place>& places) const;
  double Scatter(const std::vector<double>& residuals, const std::vector<Place>& centred) const;
  static Information NormalEquations(const std::vector<Place>& centred);

  std::vector<Place> places_;
  std::size_t feet_ = 0;  // that rest in several places
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_FLOOR_SLOPE_H_
