#include "model/engine/leader_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "model/base/angle.h"
#include "model/motion/filter.h"

namespace duet::engine {
namespace {

constexpr double kNoiseSigmaSeconds = 0.1;  // a depth camera's noise, not yet a punch
constexpr double kStillSpeed = 0.15;        // m/s, the mean joint of somebody who waits

// A leader, and what several features share.
struct Motion {
  const motion::Skeleton& skeleton;
  const motion::Poses& poses;
  double frame_rate_hz;
  motion::Poses smooth;
  std::vector<double> speeds;  // m/s, of the mean joint from each frame to the next
};

double Speed(const Motion& leader, int frame, int joint) {
  return Distance(leader.smooth.at(frame, joint), leader.smooth.at(frame + 1, joint)) *
         leader.frame_rate_hz;
}

Motion Prepare(const motion::Skeleton& skeleton, const motion::Poses& poses, double frame_rate_hz) {
  Motion leader{skeleton,
                poses,
                frame_rate_hz,
                GaussianFilter(poses, kNoiseSigmaSeconds * frame_rate_hz),
                {}};
  for (int t = 0; t + 1 < poses.frame_count(); ++t) {
    double sum = 0;
    for (int j = 0; j < poses.joint_count(); ++j) sum += Speed(leader, t, j);
    leader.speeds.push_back(sum / poses.joint_count());
  }
  return leader;
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

template <typename OfFrame>
double MeanOverFrames(const motion::Poses& poses, const OfFrame& of_frame) {
  double sum = 0;
  for (int t = 0; t < poses.frame_count(); ++t) sum += of_frame(t);
  return sum / poses.frame_count();
}

double MeanJointSpeed(const Motion& leader) { return Mean(leader.speeds); }

double HighestJointSpeed(const Motion& leader) {
  double highest = 0;
  for (int t = 0; t + 1 < leader.smooth.frame_count(); ++t) {
    for (int j = 0; j < leader.smooth.joint_count(); ++j) {
      highest = std::max(highest, Speed(leader, t, j));
    }
  }
  return highest;
}

double RootPathSpeed(const Motion& leader) {
  const int root = leader.skeleton.root, steps = leader.smooth.frame_count() - 1;
  double path = 0;
  for (int t = 0; t < steps; ++t) {
    const motion::Vec3 step = leader.smooth.at(t + 1, root) - leader.smooth.at(t, root);
    path += std::hypot(step.x, step.z);
  }
  return steps < 1 ? 0 : path * leader.frame_rate_hz / steps;
}

double RootTravel(const Motion& leader) {
  const int root = leader.skeleton.root;
  double farthest = 0;
  for (int t = 0; t < leader.smooth.frame_count(); ++t) {
    const motion::Vec3 way = leader.smooth.at(t, root) - leader.smooth.at(0, root);
    farthest = std::max<double>(farthest, std::hypot(way.x, way.z));
  }
  return farthest;
}

double StillShare(const Motion& leader) {
  if (leader.speeds.empty()) return 1;
  const auto still = std::count_if(leader.speeds.begin(), leader.speeds.end(),
                                   [](double speed) { return speed < kStillSpeed; });
  return static_cast<double>(still) / static_cast<double>(leader.speeds.size());
}

double BoneLength(const Motion& leader) {
  const std::vector<motion::Bone>& bones = leader.skeleton.bones;
  if (bones.empty()) return 0;
  return MeanOverFrames(leader.poses, [&](int t) {
    double sum = 0;
    for (const motion::Bone& bone : bones) {
      sum += Distance(leader.poses.at(t, bone.parent), leader.poses.at(t, bone.child));
    }
    return sum / static_cast<double>(bones.size());
  });
}

// The bones from a joint to the root.
double LengthToRoot(const Motion& leader, const std::vector<int>& parents, int frame, int joint) {
  double length = 0;
  for (int parent = parents[static_cast<std::size_t>(joint)]; parent >= 0;
       joint = parent, parent = parents[static_cast<std::size_t>(joint)]) {
    length += Distance(leader.poses.at(frame, joint), leader.poses.at(frame, parent));
  }
  return length;
}

double RootHeight(const Motion& leader) {
  const std::vector<int> parents = leader.skeleton.Parents();
  const motion::JointPair feet = *leader.skeleton.feet;
  return MeanOverFrames(leader.poses, [&](int t) {
    const double lower =
        std::min(leader.poses.at(t, feet.left).y, leader.poses.at(t, feet.right).y);
    const double legs = LengthToRoot(leader, parents, t, feet.left) / 2 +
                        LengthToRoot(leader, parents, t, feet.right) / 2;
    return legs > 0 ? (leader.poses.at(t, leader.skeleton.root).y - lower) / legs : 0;
  });
}

double TrunkLean(const Motion& leader) {
  const motion::JointPair hips = *leader.skeleton.hips;
  const int neck = leader.skeleton.Find("neck");
  return MeanOverFrames(leader.poses, [&](int t) {
    const motion::Vec3 middle =
        (leader.poses.at(t, hips.left) + leader.poses.at(t, hips.right)) / 2;
    const motion::Vec3 trunk = leader.poses.at(t, neck) - middle;
    return std::atan2(std::hypot(trunk.x, trunk.z), trunk.y) * base::kDegreesPerRadian;
  });
}

// The horizontal direction from the left hip to the right, of any length.
motion::Vec3 AcrossHips(const Motion& leader, int frame) {
  const motion::JointPair hips = *leader.skeleton.hips;
  const motion::Vec3 across =
      leader.smooth.at(frame, hips.right) - leader.smooth.at(frame, hips.left);
  return {across.x, 0, across.z};
}

double Turn(const Motion& leader) {
  const motion::Vec3 first = AcrossHips(leader, 0);
  double farthest = 0;
  for (int t = 1; t < leader.smooth.frame_count(); ++t) {
    const motion::Vec3 now = AcrossHips(leader, t);
    const double angle =
        std::atan2(Norm(Cross(first, now)), Dot(first, now)) * base::kDegreesPerRadian;
    farthest = std::max(farthest, angle);
  }
  return farthest;
}

double HandReach(const Motion& leader) {
  const int left = leader.skeleton.Find("left_hand"), right = leader.skeleton.Find("right_hand");
  return MeanOverFrames(leader.poses, [&](int t) {
    const motion::Vec3 root = leader.poses.at(t, leader.skeleton.root);
    return std::max(Distance(leader.poses.at(t, left), root),
                    Distance(leader.poses.at(t, right), root));
  });
}

bool Always(const motion::Skeleton& /*skeleton*/) { return true; }
bool HasFeet(const motion::Skeleton& skeleton) { return skeleton.feet.has_value(); }
bool HasHips(const motion::Skeleton& skeleton) { return skeleton.hips.has_value(); }
bool HasTrunk(const motion::Skeleton& skeleton) {
  return skeleton.hips.has_value() && skeleton.Find("neck") >= 0;
}
bool HasHands(const motion::Skeleton& skeleton) {
  return skeleton.Find("left_hand") >= 0 && skeleton.Find("right_hand") >= 0;
}

struct Measure {
  LeaderFeature feature;
  bool (*is_given)(const motion::Skeleton&);
  double (*value)(const Motion&);
};

constexpr Measure kMeasures[] = {
    {{"mean_joint_speed", 0.05}, Always, MeanJointSpeed},
    {{"highest_joint_speed", 0.3}, Always, HighestJointSpeed},
    {{"root_path_speed", 0.05}, Always, RootPathSpeed},
    {{"root_travel", 0.05}, Always, RootTravel},
    {{"still_share", 0.1}, Always, StillShare},
    {{"bone_length", 0.01}, Always, BoneLength},
    {{"root_height", 0.02}, HasFeet, RootHeight},
    {{"turn", 5}, HasHips, Turn},
    {{"trunk_lean", 2}, HasTrunk, TrunkLean},
    {{"hand_reach", 0.05}, HasHands, HandReach},
};

// Where training leaders are nearer than this to their mean, in deviations, they are too few or too
// alike to tell what is far.
constexpr double kSmallestScale = 0.5;

LeaderStatistics::Feature Fit(const LeaderFeature& feature,
                              const std::vector<std::vector<double>>& leaders, std::size_t index) {
  const auto count = static_cast<double>(leaders.size());
  double mean = 0, square = 0;
  for (const std::vector<double>& values : leaders) mean += values[index] / count;
  for (const std::vector<double>& values : leaders) {
    square += (values[index] - mean) * (values[index] - mean) / count;
  }
  return {std::string(feature.name), mean, std::max(std::sqrt(square), feature.smallest_deviation)};
}

}  // namespace

std::vector<LeaderFeature> LeaderFeatures(const motion::Skeleton& skeleton) {
  std::vector<LeaderFeature> features;
  for (const Measure& measure : kMeasures) {
    if (measure.is_given(skeleton)) features.push_back(measure.feature);
  }
  return features;
}

std::vector<double> MeasureLeader(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                  double frame_rate_hz) {
  const Motion prepared = Prepare(skeleton, leader, frame_rate_hz);
  std::vector<double> values;
  for (const Measure& measure : kMeasures) {
    if (measure.is_given(skeleton)) values.push_back(measure.value(prepared));
  }
  return values;
}

LeaderStatistics FitLeaderStatistics(const motion::Skeleton& skeleton,
                                     const std::vector<const motion::Poses*>& leaders,
                                     double frame_rate_hz) {
  std::vector<std::vector<double>> values;
  values.reserve(leaders.size());
  for (const motion::Poses* leader : leaders) {
    values.push_back(MeasureLeader(skeleton, *leader, frame_rate_hz));
  }
  LeaderStatistics statistics;
  const std::vector<LeaderFeature> features = LeaderFeatures(skeleton);
  for (std::size_t i = 0; i < features.size(); ++i) {
    statistics.features.push_back(Fit(features[i], values, i));
  }
  std::vector<double> distances;
  distances.reserve(leaders.size());
  for (const motion::Poses* leader : leaders) {
    distances.push_back(Unfamiliarity(statistics, skeleton, *leader, frame_rate_hz));
  }
  statistics.scale = std::max(NinthDecile(std::move(distances)), kSmallestScale);
  return statistics;
}

double Unfamiliarity(const LeaderStatistics& statistics, const motion::Skeleton& skeleton,
                     const motion::Poses& leader, double frame_rate_hz) {
  const std::vector<LeaderFeature> features = LeaderFeatures(skeleton);
  const std::vector<double> values = MeasureLeader(skeleton, leader, frame_rate_hz);
  double square = 0;
  int count = 0;
  for (const LeaderStatistics::Feature& known : statistics.features) {
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (features[i].name != known.name) continue;
      square += std::pow((values[i] - known.mean) / known.deviation, 2);
      ++count;
    }
  }
  return count == 0 ? 0 : std::sqrt(square / count) / statistics.scale;
}

double NinthDecile(std::vector<double> values) {
  const std::size_t rank = (values.size() * 9 + 9) / 10 - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

}  // namespace duet::engine
