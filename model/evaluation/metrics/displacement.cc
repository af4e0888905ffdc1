#include "model/evaluation/metrics/displacement.h"

#include <cmath>
#include <cstddef>

#include "model/motion/coordinates.h"

namespace duet::evaluation::metrics {
namespace {

// Uses the data set's own conversion, so that its constants are defined once.
motion::Vec3 InUnit(MetricUnit unit, motion::Vec3 metres) {
  if (unit == MetricUnit::kMetres) return metres;
  return FromWorld({motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown}, metres);
}

double SquaredDistance(motion::Vec3 a, motion::Vec3 b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return x * x + y * y + z * z;
}

// The squared norm of x^_t - x_t over all coordinates of a frame.
double FrameSquared(absl::Span<const motion::Vec3> predicted, absl::Span<const motion::Vec3> truth,
                    MetricUnit unit) {
  double squared = 0;
  for (size_t j = 0; j < truth.size(); ++j) {
    squared += SquaredDistance(InUnit(unit, predicted[j]), InUnit(unit, truth[j]));
  }
  return squared;
}

motion::Poses WithoutRoot(motion::Poses poses, int root) {
  for (int t = 0; t < poses.frame_count(); ++t) {
    const motion::Vec3 at = poses.at(t, root);
    for (motion::Vec3& position : poses[t]) position = position - at;
  }
  return poses;
}

}  // namespace

double Afd(const motion::Poses& predicted, const motion::Poses& truth, MetricUnit unit) {
  double sum = 0;
  for (int t = 0; t < truth.frame_count(); ++t) {
    sum += std::sqrt(FrameSquared(predicted[t], truth[t], unit));
  }
  return sum / truth.frame_count();
}

double AfdSquared(const motion::Poses& predicted, const motion::Poses& truth, MetricUnit unit) {
  double sum = 0;
  for (int t = 0; t < truth.frame_count(); ++t) sum += FrameSquared(predicted[t], truth[t], unit);
  return sum / truth.frame_count();
}

double RootAlignedAfd(const motion::Poses& predicted, const motion::Poses& truth, int root,
                      MetricUnit unit) {
  return Afd(WithoutRoot(predicted, root), WithoutRoot(truth, root), unit);
}

double VelocityError(const motion::Poses& predicted, const motion::Poses& truth,
                     double frame_rate_hz) {
  double sum = 0;
  for (int t = 1; t < truth.frame_count(); ++t) {
    for (int j = 0; j < truth.joint_count(); ++j) {
      sum += std::sqrt(SquaredDistance(predicted.at(t, j) - predicted.at(t - 1, j),
                                       truth.at(t, j) - truth.at(t - 1, j)));
    }
  }
  return sum / ((truth.frame_count() - 1) * truth.joint_count()) * frame_rate_hz;
}

}  // namespace duet::evaluation::metrics
