#ifndef DUET_CONTRIB_LOAD_GENERATOR_H_
#define DUET_CONTRIB_LOAD_GENERATOR_H_

#include "contrib/load/load_options.h"
#include "contrib/load/measurement.h"
#include "contrib/load/target.h"

namespace duet::contrib::load {

// Puts a load on a target. Returns after every call has ended.
//
// Closed loop: a call is due when its caller's previous one has ended. Open loop: due times are
// independent of the answers, so a pause of the server delays every call that is due in it.
Measurement RunStep(const Step& step, const LoadOptions& options, Target& target);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_GENERATOR_H_
