#ifndef DUET_SERVER_SERVICE_WINDOW_CHECK_H_
#define DUET_SERVER_SERVICE_WINDOW_CHECK_H_

#include "absl/status/status.h"
#include "model/engine/synthesizer.h"

namespace duet::server::service {

// Returns the error of a window's result, or INTERNAL if an engine that violates its contract
// returned another shape than [frames, joints], or positions that are not finite.
absl::Status CheckWindow(const engine::WindowResult& result, int frames, int joints);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_WINDOW_CHECK_H_
