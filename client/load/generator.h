#ifndef DUET_CLIENT_LOAD_GENERATOR_H_
#define DUET_CLIENT_LOAD_GENERATOR_H_

#include "client/load/load_options.h"
#include "client/load/measurement.h"
#include "client/load/target.h"

namespace duet::client::load {

// Puts a load on a target, and returns once every call has ended.
//
// Closed loop: a call is due when its caller's last one has ended. Open loop: by the timetable
// alone, so that a server that stands still for a second has a second's calls to answer for.
Measurement RunStep(const Step& step, const LoadOptions& options, Target& target);

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_GENERATOR_H_
