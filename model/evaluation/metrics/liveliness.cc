#include "model/evaluation/metrics/liveliness.h"

#include <algorithm>

namespace duet::evaluation::metrics {

double JointSpeed(const motion::Poses& poses, double frame_rate_hz) {
  const int steps = poses.frame_count() - 1, joints = poses.joint_count();
  if (steps < 1) return 0;
  double sum = 0;
  for (int t = 0; t < steps; ++t) {
    for (int j = 0; j < joints; ++j) sum += Distance(poses.at(t, j), poses.at(t + 1, j));
  }
  return sum / (steps * joints) * frame_rate_hz;
}

double RangeOfMotion(const motion::Poses& poses) {
  double sum = 0;
  for (int j = 0; j < poses.joint_count(); ++j) {
    float farthest = 0;
    for (int t = 0; t < poses.frame_count(); ++t) {
      farthest = std::max(farthest, Distance(poses.at(t, j), poses.at(0, j)));
    }
    sum += farthest;
  }
  return sum / poses.joint_count();
}

}  // namespace duet::evaluation::metrics
