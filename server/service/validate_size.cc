#include "server/service/validate_size.h"

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/median.h"

namespace duet::server::service {
namespace {

// Half of an adult's joints are about 0.4 m from the middle, a baby's 0.1 m. Centimetres declared
// as metres give 40 m, metres declared as millimetres 0.0004 m.
constexpr float kSmallestMetres = 0.05f;
constexpr float kLargestMetres = 4;
// Enough to outvote frames without a person, and few enough for ten minutes at 240 Hz.
constexpr int kFrames = 31;

// Median distance of the joints from their middle.
float SizeOf(absl::Span<const motion::Vec3> pose) {
  std::vector<float> x, y, z, distances;
  for (const motion::Vec3& joint : pose) {
    x.push_back(joint.x);
    y.push_back(joint.y);
    z.push_back(joint.z);
  }
  const motion::Vec3 middle = {base::Median(std::move(x)), base::Median(std::move(y)),
                               base::Median(std::move(z))};
  distances.reserve(pose.size());
  for (const motion::Vec3& joint : pose) distances.push_back(Norm(joint - middle));
  return base::Median(std::move(distances));
}

// A clip in which nobody was ever captured. It needs every frame: those with a person may be few.
bool ShowsNobody(const motion::Poses& poses) {
  for (int frame = 0; frame < poses.frame_count(); ++frame) {
    if (!IsPoint(poses[frame])) return false;
  }
  return poses.joint_count() > 1;
}

}  // namespace

bool IsPoint(absl::Span<const motion::Vec3> pose) {
  return std::all_of(pose.begin(), pose.end(),
                     [&pose](const motion::Vec3& joint) { return joint == pose.front(); });
}

void ValidateSize(absl::string_view field, const motion::Poses& poses, Violations& violations) {
  const int frames = poses.frame_count();
  if (frames == 0) return;
  const int samples = std::min(frames, kFrames);
  std::vector<float> sizes;
  for (int i = 0; i < samples; ++i) {
    const int frame = static_cast<int>(static_cast<long>(frames) * i / samples);
    sizes.push_back(SizeOf(poses[frame]));
  }
  const float size = base::Median(std::move(sizes));
  const bool nobody = size == 0 && ShowsNobody(poses);
  if (!nobody && (size == 0 || (size >= kSmallestMetres && size <= kLargestMetres))) return;
  violations.Malformed(std::string(field),
                       absl::StrCat("the size of a person (half of the joints ", kSmallestMetres,
                                    " to ", kLargestMetres, " m from the middle)"),
                       nobody ? "all joints in one point in every frame"
                              : absl::StrFormat("%.3g m; check leader.unit (convert centimetres to "
                                                "millimetres)",
                                                size));
}

}  // namespace duet::server::service
