#ifndef DUET_CONTRIB_LOAD_LIVE_GENERATOR_H_
#define DUET_CONTRIB_LOAD_LIVE_GENERATOR_H_

#include "contrib/load/live_measurement.h"
#include "contrib/load/live_options.h"
#include "contrib/load/live_target.h"

namespace duet::contrib::load {

// Runs live sessions side by side for the warm-up and the measured time. Frames are due when a
// camera would deliver them, whether or not the server answers. Returns after every session has
// ended.
LiveMeasurement RunLive(const LiveOptions& options, LiveTarget& target);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_GENERATOR_H_
