#ifndef DUET_MODEL_SOLVER_BODY_MODEL_H_
#define DUET_MODEL_SOLVER_BODY_MODEL_H_

#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::solver {

// The body of one person: constant bones, and a pelvis and shoulders that are rigid.
//
// Units: metres, y up.
class BodyModel {
 public:
  // Measures a person. Lengths and shapes are medians over the frames.
  // Errors: INVALID_ARGUMENT naming what a skeleton lacks: hips, feet, two legs of two bones and a
  // trunk; or a person without frames.
  static absl::StatusOr<BodyModel> Measure(const motion::Skeleton& skeleton,
                                           const motion::Poses& person);

  // Replaces a pose by the nearest one of this body: the directions of its bones and the bends of
  // its limbs are kept. Shapes: pose [joints].
  void Fit(absl::Span<motion::Vec3> pose) const;
  // The same, with the feet where they are, as far as the legs reach.
  void FitAboveFeet(absl::Span<motion::Vec3> pose) const;

  // The same body in another size.
  void Scale(float factor);

  // Left and right.
  const std::vector<body::Limb>& legs() const { return legs_; }
  // The length of a leg, stretched. `leg`: index into legs().
  float LegLength(int leg) const;

  // How far the bones of `person` are from a constant length: the deviation of each bone's length
  // over the frames, averaged over the bones. A solved capture has (nearly) none.
  static double BoneNoise(const motion::Skeleton& skeleton, const motion::Poses& person);

 private:
  // A bone, directed away from the pelvis.
  struct Segment {
    int from = 0;
    int to = 0;
    float length = 0;
  };
  // Joints that move as one, with their places in axes of the group.
  struct Rigid {
    std::vector<int> joints;
    std::vector<motion::Vec3> places;  // along the line from right to left, the trunk, and across
  };
  struct Axes {
    motion::Vec3 across, up, forward;
  };

  Axes AxesOf(int left, int right, absl::Span<const motion::Vec3> pose) const;
  Rigid MeasureRigid(const std::vector<int>& joints, int origin, int left, int right,
                     const motion::Poses& person) const;
  void FitLimb(const body::Limb& limb, absl::Span<const motion::Vec3> old,
               absl::Span<motion::Vec3> pose) const;

  std::vector<body::Limb> legs_, arms_;
  motion::JointPair hips_, shoulders_;
  int chest_ = 0;
  Rigid pelvis_, girdle_;
  std::vector<Segment> segments_;  // outwards, without those of rigid groups
};

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_BODY_MODEL_H_
