#include "server/service/window_check.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "absl/types/span.h"
#include "model/motion/vec3.h"

namespace duet::server::service {

absl::Status CheckWindow(const engine::WindowResult& result, int frames, int joints) {
  if (!result.ok()) return result.status();
  const absl::Span<const motion::Vec3> positions = result->all();
  if (result->joint_count() != joints || result->frame_count() != frames ||
      positions.size() % static_cast<std::size_t>(joints) != 0) {
    return absl::InternalError("model: expected " + std::to_string(frames) + " frames of " +
                               std::to_string(joints) + " joints, got " +
                               std::to_string(positions.size()) + " positions in frames of " +
                               std::to_string(result->joint_count()) + " joints");
  }
  if (!std::all_of(positions.begin(), positions.end(), motion::IsFinite)) {
    return absl::InternalError("model: expected finite positions, got one that is not finite");
  }
  return absl::OkStatus();
}

}  // namespace duet::server::service
