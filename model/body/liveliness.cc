#include "model/body/liveliness.h"

#include <algorithm>
#include <cmath>

namespace duet::body {
namespace {

double PreciseDistance(motion::Vec3 a, motion::Vec3 b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

double JointSpeed(const motion::Poses& poses, double frame_rate_hz) {
  const int steps = poses.frame_count() - 1, joints = poses.joint_count();
  if (steps < 1) return 0;
  double sum = 0;
  for (int t = 0; t < steps; ++t) {
    for (int j = 0; j < joints; ++j) sum += Distance(poses.at(t, j), poses.at(t + 1, j));
  }
  return sum / (steps * joints) * frame_rate_hz;
}

double VelocityError(const motion::Poses& predicted, const motion::Poses& truth,
                     double frame_rate_hz) {
  double sum = 0;
  for (int t = 1; t < truth.frame_count(); ++t) {
    for (int j = 0; j < truth.joint_count(); ++j) {
      sum += PreciseDistance(predicted.at(t, j) - predicted.at(t - 1, j),
                             truth.at(t, j) - truth.at(t - 1, j));
    }
  }
  return sum / ((truth.frame_count() - 1) * truth.joint_count()) * frame_rate_hz;
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

}  // namespace duet::body
