#ifndef DUET_MODEL_EVALUATION_METRICS_DISPLACEMENT_H_
#define DUET_MODEL_EVALUATION_METRICS_DISPLACEMENT_H_

#include "model/motion/poses.h"

// Distances between a synthesised follower and the captured one.
//
// Shapes: predicted and truth are alike, of one frame or more (two for VelocityError), in world
//         metres, y up. Differing shapes are a programmer's error.
//
// In metres, every figure is invariant to a common translation and a common rotation about the
// vertical. In the raw unit, whose axes have different scales, it is invariant only to translation:
// pass motions in world coordinates, as captured, not levelled. The paper also rotates them, but
// after the scaling, which changes no norm.

namespace duet::evaluation::metrics {

// The unit that a displacement is measured in.
enum class MetricUnit {
  kMetres,
  // The unit of the paper's figures: SBU's normalised one, 1/2.56, 1/1.92 and 1/1.28 a metre along
  // x, y and z (Coordinates, kSbuNormalised).
  kSbuRaw
};

// Average frame distance: (1/T) sum_t | x^_t - x_t |, the Euclidean norm over all 3 J coordinates.
// Source: paper, Eq. 6.
double Afd(const motion::Poses& predicted, const motion::Poses& truth, MetricUnit unit);

// The same with the squared norm, as in the authors' released code. Unit: square of `unit`.
double AfdSquared(const motion::Poses& predicted, const motion::Poses& truth, MetricUnit unit);

// Afd after each follower's own root joint is subtracted in every frame: the pose without the
// place.
double RootAlignedAfd(const motion::Poses& predicted, const motion::Poses& truth, int root,
                      MetricUnit unit);

// The mean over frames and joints of | v^ - v |, v the difference of successive frames. Unit: m/s.
double VelocityError(const motion::Poses& predicted, const motion::Poses& truth,
                     double frame_rate_hz);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_DISPLACEMENT_H_
