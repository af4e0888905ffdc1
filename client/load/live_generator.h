#ifndef DUET_CLIENT_LOAD_LIVE_GENERATOR_H_
#define DUET_CLIENT_LOAD_LIVE_GENERATOR_H_

#include "client/load/live_measurement.h"
#include "client/load/live_options.h"
#include "client/load/live_target.h"

namespace duet::client::load {

// Runs live sessions side by side for the warm-up and the measured time. Frames are due when a
// camera would deliver them, whether or not the server answers. Returns after every session has
// ended.
LiveMeasurement RunLive(const LiveOptions& options, LiveTarget& target);

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_LIVE_GENERATOR_H_
