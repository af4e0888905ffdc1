#ifndef DUET_CLIENT_LOAD_LIVE_START_H_
#define DUET_CLIENT_LOAD_LIVE_START_H_

#include "absl/status/statusor.h"
#include "client/load/live_content.h"
#include "client/result.h"
#include "duet/v1/live.pb.h"

namespace duet::client::load {

// The first message of a session with leader frames at a rate, without frames.
// Errors: INVALID_ARGUMENT for values that the proto cannot represent.
absl::StatusOr<v1::LiveStart> MakeLiveStart(const LiveContent& content, const ModelInfo& model,
                                            double frame_rate_hz);

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_LIVE_START_H_
