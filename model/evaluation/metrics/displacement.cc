#include "model/evaluation/metrics/displacement.h"

#include <cmath>
#include <cstddef>

#include "model/motion/coordinates.h"

namespace duet::evaluation::metrics {
namespace {

// Through the data set's own conversion, so that its constants stand in one place.
motion::Vec3 InUnit(MetricUnit unit, motion::Vec3 metres) {
  if (unit == MetricUnit::kMetres) return metres;
  return FromWorld({motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown}, metres);
}

double SquaredDistance(motion::Vec3 a, motion::Vec3 b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return x * x + y * y + z * z;
}

// Calls visit(squared norm of x^_t - x_t) for every frame.
template <typename Visit>
void ForEachFrame(const std::vector<motion::Vec3>& predicted,
                  const std::vector<motion::Vec3>& truth, int joints, MetricUnit unit,
                  Visit visit) {
  const size_t stride = static_cast<size_t>(joints);
  for (size_t first = 0; first < truth.size(); first += stride) {
    double squared = 0;
    for (size_t i = first; i < first + stride; ++i) {
      squared += SquaredDistance(InUnit(unit, predicted[i]), InUnit(unit, truth[i]));
    }
    visit(squared);
  }
}

double FrameCount(const std::vector<motion::Vec3>& positions, int joints) {
  return static_cast<double>(positions.size()) / joints;
}

std::vector<motion::Vec3> WithoutRoot(const std::vector<motion::Vec3>& positions, int joints,
                                      int root) {
  std::vector<motion::Vec3> relative(positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    const size_t first = i - i % static_cast<size_t>(joints);
    relative[i] = positions[i] - positions[first + static_cast<size_t>(root)];
  }
  return relative;
}

}  // namespace

double Afd(const std::vector<motion::Vec3>& predicted, const std::vector<motion::Vec3>& truth,
           int joints, MetricUnit unit) {
  double sum = 0;
  ForEachFrame(predicted, truth, joints, unit, [&](double squared) { sum += std::sqrt(squared); });
  return sum / FrameCount(truth, joints);
}

double AfdSquared(const std::vector<motion::Vec3>& predicted,
                  const std::vector<motion::Vec3>& truth, int joints, MetricUnit unit) {
  double sum = 0;
  ForEachFrame(predicted, truth, joints, unit, [&](double squared) { sum += squared; });
  return sum / FrameCount(truth, joints);
}

double RootAlignedAfd(const std::vector<motion::Vec3>& predicted,
                      const std::vector<motion::Vec3>& truth, int joints, int root,
                      MetricUnit unit) {
  return Afd(WithoutRoot(predicted, joints, root), WithoutRoot(truth, joints, root), joints, unit);
}

double VelocityError(const std::vector<motion::Vec3>& predicted,
                     const std::vector<motion::Vec3>& truth, int joints, double frame_rate_hz) {
  const size_t stride = static_cast<size_t>(joints);
  double sum = 0;
  for (size_t i = stride; i < truth.size(); ++i) {
    sum += std::sqrt(
        SquaredDistance(predicted[i] - predicted[i - stride], truth[i] - truth[i - stride]));
  }
  return sum / static_cast<double>(truth.size() - stride) * frame_rate_hz;
}

}  // namespace duet::evaluation::metrics
