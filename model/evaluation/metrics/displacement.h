#ifndef DUET_MODEL_EVALUATION_METRICS_DISPLACEMENT_H_
#define DUET_MODEL_EVALUATION_METRICS_DISPLACEMENT_H_

#include <vector>

#include "model/motion/vec3.h"

// How far a synthesised follower is from the captured one.
//
// Shapes: predicted and truth [frames, joints], the same number of frames, at least one (two for
//         VelocityError), in world metres, y up. Differing shapes are a programmer's error.
// Every figure is invariant to moving both motions alike and to turning them about the vertical,
// so that it does not matter whether the leader's root and yaw have been taken out before. (In the
// raw unit the second holds for the paper as well: it turns after the anisotropic scaling, and a
// turn keeps a norm.)

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
double Afd(const std::vector<motion::Vec3>& predicted, const std::vector<motion::Vec3>& truth,
           int joints, MetricUnit unit);

// The same with the squared norm, as the authors' released code averages it. Unit: square of
// `unit`.
double AfdSquared(const std::vector<motion::Vec3>& predicted,
                  const std::vector<motion::Vec3>& truth, int joints, MetricUnit unit);

// Afd after each follower's own root joint is subtracted in every frame: the pose apart from where
// the follower stands.
double RootAlignedAfd(const std::vector<motion::Vec3>& predicted,
                      const std::vector<motion::Vec3>& truth, int joints, int root,
                      MetricUnit unit);

// The mean over frames and joints of | v^ - v |, v the difference of successive frames. Unit: m/s.
double VelocityError(const std::vector<motion::Vec3>& predicted,
                     const std::vector<motion::Vec3>& truth, int joints, double frame_rate_hz);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_DISPLACEMENT_H_
