#ifndef DUET_CONTRIB_LOAD_LIVE_START_H_
#define DUET_CONTRIB_LOAD_LIVE_START_H_

#include "absl/status/statusor.h"
#include "client/result.h"
#include "contrib/load/live_content.h"
#include "duet/v1/live.pb.h"

namespace duet::contrib::load {

// The first message of a session with leader frames at a rate, without frames.
// Errors: INVALID_ARGUMENT for values that the proto cannot represent.
absl::StatusOr<v1::LiveStart> MakeLiveStart(const LiveContent& content,
                                            const client::ModelInfo& model, double frame_rate_hz);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_START_H_
