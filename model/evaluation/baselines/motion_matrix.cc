#include "model/evaluation/baselines/motion_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace duet::evaluation::baselines {
namespace {

// Frames on either side that a velocity is taken over.
constexpr Eigen::Index kVelocityReach = 2;
// Metres that the whole duration counts as, beside a pose of 3 J coordinates.
constexpr double kTimeWeight = 1.0;
// Weight of one metre of the root's way, which moves all joints.
constexpr double kWayWeight = 2.0;

}  // namespace

motion::Standardisation BaselineFrame(const motion::Skeleton& skeleton,
                                      const dataset::Sequence& sequence) {
  const std::vector<motion::Vec3>& leader = sequence.pair.leader.positions;
  if (sequence.partner_direction) {
    return {skeleton, leader, FacingYaw(*sequence.partner_direction)};
  }
  return {skeleton, leader};
}

Rows ToRows(const std::vector<motion::Vec3>& positions, int joints) {
  const Eigen::Index width = 3 * static_cast<Eigen::Index>(joints);
  const Eigen::Index frames = static_cast<Eigen::Index>(positions.size()) * 3 / width;
  Rows rows(frames, width);
  for (size_t i = 0; i < positions.size(); ++i) {
    double* out = rows.data() + 3 * i;
    out[0] = positions[i].x;
    out[1] = positions[i].y;
    out[2] = positions[i].z;
  }
  return rows;
}

std::vector<motion::Vec3> FromRows(const Rows& rows) {
  std::vector<motion::Vec3> positions(static_cast<size_t>(rows.size()) / 3);
  for (size_t i = 0; i < positions.size(); ++i) {
    const double* p = rows.data() + 3 * i;
    positions[i] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  }
  return positions;
}

Rows LeaderCues(const motion::Standardisation& frame, const std::vector<motion::Vec3>& world,
                int joints) {
  const Rows pose = ToRows(frame.Apply(world), joints);
  const Eigen::Index frames = pose.rows(), width = pose.cols();
  Rows cues(frames, 2 * width + 4);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index before = std::max<Eigen::Index>(t - kVelocityReach, 0);
    const Eigen::Index after = std::min(t + kVelocityReach, frames - 1);
    cues.row(t).head(width) = pose.row(t);
    cues.row(t).segment(width, width) = pose.row(after) - pose.row(before);
    // Standard and world differ by the root's way, turned: any joint tells it.
    const size_t joint = static_cast<size_t>(t) * static_cast<size_t>(joints);
    const motion::Vec3 way =
        frame.Apply(world[joint]) - motion::Vec3{static_cast<float>(pose(t, 0)),
                                                 static_cast<float>(pose(t, 1)),
                                                 static_cast<float>(pose(t, 2))};
    cues.row(t).segment(2 * width, 3) = kWayWeight * Eigen::RowVector3d(way.x, way.y, way.z);
    cues(t, 2 * width + 3) = kTimeWeight * static_cast<double>(t) /
                             static_cast<double>(std::max<Eigen::Index>(frames - 1, 1));
  }
  return cues;
}

StandardPair StandardLeader(const motion::Skeleton& skeleton, const dataset::Sequence& sequence) {
  const motion::Standardisation frame = BaselineFrame(skeleton, sequence);
  const std::vector<motion::Vec3>& leader = sequence.pair.leader.positions;
  StandardPair pair;
  pair.leader = ToRows(frame.Apply(leader), skeleton.joint_count());
  pair.cues = LeaderCues(frame, leader, skeleton.joint_count());
  return pair;
}

StandardPair StandardiseSequence(const motion::Skeleton& skeleton,
                                 const dataset::Sequence& sequence) {
  StandardPair pair = StandardLeader(skeleton, sequence);
  const motion::Standardisation frame = BaselineFrame(skeleton, sequence);
  pair.follower = ToRows(frame.Apply(sequence.pair.follower.positions), skeleton.joint_count());
  return pair;
}

std::vector<motion::Vec3> FollowerToWorld(const motion::Skeleton& skeleton,
                                          const dataset::Sequence& sequence, const Rows& follower) {
  return BaselineFrame(skeleton, sequence).Invert(FromRows(follower));
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

}  // namespace duet::evaluation::baselines
