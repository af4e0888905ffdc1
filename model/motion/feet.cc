#include "model/motion/feet.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace duet::motion {

std::vector<float> LowerFoot(const JointPair& feet, const Poses& poses) {
  std::vector<float> heights;
  for (int t = 0; t < poses.frame_count(); ++t) {
    heights.push_back(std::min(poses.at(t, feet.left).y, poses.at(t, feet.right).y));
  }
  return heights;
}

float LowestFoot(const JointPair& feet, const Poses& poses) {
  float lowest = std::numeric_limits<float>::infinity();
  for (const float height : LowerFoot(feet, poses)) lowest = std::min(lowest, height);
  return lowest;
}

float FloorHeight(const JointPair& feet, const Poses& poses) {
  std::vector<float> heights = LowerFoot(feet, poses);
  const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), low, heights.end());
  return *low;
}

}  // namespace duet::motion
