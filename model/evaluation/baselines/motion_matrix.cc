#include "model/evaluation/baselines/motion_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace duet::evaluation::baselines {
namespace {

// Frames on either side over which a velocity is measured.
constexpr Eigen::Index kVelocityReach = 2;
// Metres that correspond to the whole duration, relative to a pose of 3 J coordinates.
constexpr double kTimeWeight = 1.0;
// Weight of one metre of the root's path, which moves all joints.
constexpr double kWayWeight = 2.0;

// A matching's cost so far and its number of matched rows.
struct Path {
  double cost = std::numeric_limits<double>::infinity();
  int length = 0;
};

const Path& Cheapest(const Path& a, const Path& b, const Path& c) {
  const Path& ab = a.cost <= b.cost ? a : b;
  return ab.cost <= c.cost ? ab : c;
}

}  // namespace

motion::Standardisation BaselineStandardisation(const motion::Skeleton& skeleton,
                                                const dataset::Sequence& sequence,
                                                motion::StandardOrigin origin) {
  const motion::Poses& leader = sequence.pair.leader.poses;
  if (sequence.partner_direction) {
    return {skeleton, leader, FacingYaw(*sequence.partner_direction), origin};
  }
  return {skeleton, leader, motion::YawDirection::kRemove, origin};
}

Rows ToRows(const motion::Poses& poses) {
  Rows rows(poses.frame_count(), 3 * poses.joint_count());
  double* out = rows.data();
  for (const motion::Vec3& position : poses.all()) {
    *out++ = position.x;
    *out++ = position.y;
    *out++ = position.z;
  }
  return rows;
}

motion::Poses FromRows(const Rows& rows) {
  motion::Poses poses(static_cast<int>(rows.rows()), static_cast<int>(rows.cols() / 3));
  const double* value = rows.data();
  for (motion::Vec3& position : poses.all()) {
    position = {static_cast<float>(value[0]), static_cast<float>(value[1]),
                static_cast<float>(value[2])};
    value += 3;
  }
  return poses;
}

Rows LeaderCues(const motion::Standardisation& frame, const motion::Poses& world) {
  const Rows pose = ToRows(frame.Apply(world));
  const Eigen::Index frames = pose.rows(), width = pose.cols();
  Rows cues(frames, 2 * width + 4);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index before = std::max<Eigen::Index>(t - kVelocityReach, 0);
    const Eigen::Index after = std::min(t + kVelocityReach, frames - 1);
    cues.row(t).head(width) = pose.row(t);
    cues.row(t).segment(width, width) = pose.row(after) - pose.row(before);
    // For any joint, its coordinates in this frame's system and in the first frame's differ by the
    // root's movement.
    const motion::Vec3 way =
        frame.Apply(world.at(static_cast<int>(t), 0)) -
        motion::Vec3{static_cast<float>(pose(t, 0)), static_cast<float>(pose(t, 1)),
                     static_cast<float>(pose(t, 2))};
    cues.row(t).segment(2 * width, 3) = kWayWeight * Eigen::RowVector3d(way.x, way.y, way.z);
    cues(t, 2 * width + 3) = kTimeWeight * static_cast<double>(t) /
                             static_cast<double>(std::max<Eigen::Index>(frames - 1, 1));
  }
  return cues;
}

StandardPair StandardLeader(const motion::Skeleton& skeleton, const dataset::Sequence& sequence) {
  const motion::Standardisation frame = BaselineStandardisation(skeleton, sequence);
  const motion::Poses& leader = sequence.pair.leader.poses;
  StandardPair pair;
  pair.leader = ToRows(frame.Apply(leader));
  pair.cues = LeaderCues(frame, leader);
  return pair;
}

StandardPair StandardiseSequence(const motion::Skeleton& skeleton,
                                 const dataset::Sequence& sequence) {
  StandardPair pair = StandardLeader(skeleton, sequence);
  const motion::Poses& follower = sequence.pair.follower.poses;
  pair.follower = ToRows(BaselineStandardisation(skeleton, sequence).Apply(follower));
  return pair;
}

motion::Poses FollowerToWorld(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                              const Rows& follower) {
  return BaselineStandardisation(skeleton, sequence).Invert(FromRows(follower));
}

Rows StretchTo(const Rows& motion, Eigen::Index frames) {
  Rows out(frames, motion.cols());
  const double last = static_cast<double>(motion.rows() - 1);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const double at =
        frames == 1 ? 0 : static_cast<double>(t) * last / static_cast<double>(frames - 1);
    const Eigen::Index whole = std::min(static_cast<Eigen::Index>(at), motion.rows() - 1);
    const Eigen::Index next = std::min(whole + 1, motion.rows() - 1);
    out.row(t) = motion.row(whole) +
                 (at - static_cast<double>(whole)) * (motion.row(next) - motion.row(whole));
  }
  return out;
}

double TimeWarpedDistance(const Rows& a, const Rows& b) {
  const size_t width = static_cast<size_t>(b.rows());
  // One row of the table at a time; index 0 stands for "before the first row of b".
  std::vector<Path> previous(width + 1), current(width + 1);
  previous[0].cost = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    current[0] = Path{};
    for (size_t j = 1; j <= width; ++j) {
      const Path& from = Cheapest(previous[j - 1], previous[j], current[j - 1]);
      const double distance = (a.row(i) - b.row(static_cast<Eigen::Index>(j) - 1)).norm();
      current[j] = {from.cost + distance, from.length + 1};
    }
    std::swap(previous, current);
  }
  return previous[width].cost / previous[width].length;
}

Eigen::MatrixXd SquaredDistances(const Rows& a, const Rows& b) {
  Eigen::MatrixXd distances = -2 * a * b.transpose();
  distances.colwise() += a.rowwise().squaredNorm();
  distances.rowwise() += b.rowwise().squaredNorm().transpose();
  return distances.cwiseMax(0);
}

}  // namespace duet::evaluation::baselines
