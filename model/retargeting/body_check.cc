#include "model/retargeting/body_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/motion/reading_setting.h"

namespace duet::retargeting {
namespace {

// Frames, spread over a motion, in which distances are measured.
constexpr int kCheckedFrames = 100;
// Of the body's size.
constexpr double kOnePlace = 0.002;
// The longer of two bones over the other. Captures differ by up to a third.
constexpr double kUnequal = 1.6;

class Body {
 public:
  Body(const motion::Skeleton& skeleton, const motion::Poses& poses)
      : skeleton_(skeleton), poses_(poses) {}

  // The mean distance of two joints; -1 if the skeleton lacks one.
  double Distance(const std::string& a, const std::string& b) const {
    const int from = skeleton_.Find(a), to = skeleton_.Find(b);
    if (from < 0 || to < 0 || poses_.empty()) return -1;
    double sum = 0;
    const int frames = std::min(poses_.frame_count(), kCheckedFrames);
    for (int i = 0; i < frames; ++i) {
      const auto pose = poses_[static_cast<int>(std::int64_t{i} * poses_.frame_count() / frames)];
      sum += static_cast<double>(motion::Distance(pose[static_cast<std::size_t>(from)],
                                                  pose[static_cast<std::size_t>(to)]));
    }
    return sum / frames;
  }

  double Size() const {
    double size = 0;
    const std::string& root = skeleton_.joint_names[static_cast<std::size_t>(skeleton_.root)];
    for (const std::string& joint : skeleton_.joint_names) {
      size = std::max(size, Distance(root, joint));
    }
    return size;
  }

 private:
  const motion::Skeleton& skeleton_;
  const motion::Poses& poses_;
};

}  // namespace

absl::Status CheckBody(absl::string_view source, const motion::Skeleton& skeleton,
                       const motion::Poses& poses, const JointMap& map,
                       const std::vector<std::string>& file_joints) {
  const Body body(skeleton, poses);
  for (const char* name : {"hip", "shoulder"}) {
    const std::string left = absl::StrCat("left_", name), right = absl::StrCat("right_", name);
    const double distance = body.Distance(left, right);
    if (distance < 0 || !(distance < kOnePlace * body.Size())) continue;
    const auto in_file = [&](const std::string& joint) {
      const auto index = static_cast<std::size_t>(skeleton.Find(joint));
      return file_joints[static_cast<std::size_t>(map.sources[index].terms[0].joint)];
    };
    return MendedBy(absl::InvalidArgumentError(
                        absl::StrCat(source, ": joints: expected ", left, " and ", right,
                                     " in two places, got ", in_file(left), " and ", in_file(right),
                                     " in one; specify a joint map such as ", left, "=NAME")),
                    motion::ReadingSetting::kJointMap);
  }
  return absl::OkStatus();
}

std::vector<std::string> UnequalBones(const motion::Skeleton& skeleton,
                                      const motion::Poses& poses) {
  const Body body(skeleton, poses);
  const char* const bones[][2] = {
      {"shoulder", "elbow"}, {"elbow", "hand"}, {"hip", "knee"}, {"knee", "foot"}};
  std::vector<std::string> lines;
  for (const auto& [from, to] : bones) {
    const auto length = [&body, from = from, to = to](const char* side) {
      return body.Distance(absl::StrCat(side, from), absl::StrCat(side, to));
    };
    const double left = length("left_"), right = length("right_");
    if (left < 0 || right < 0) continue;
    if (std::max(left, right) <= kUnequal * std::min(left, right)) continue;
    lines.push_back(absl::StrFormat(
        "joints: expected equal lengths from %s to %s on both sides, got %.2f m on the left and "
        "%.2f m on the right; is one of them another joint? Then specify a joint map",
        from, to, left, right));
  }
  return lines;
}

}  // namespace duet::retargeting
