#include "contrib/load/arrivals.h"

#include <cmath>

namespace duet::contrib::load {

Arrivals::Arrivals(ArrivalKind kind, double rate_hz, uint64_t seed)
    : kind_(kind), rate_hz_(rate_hz), random_(seed) {}

Duration Arrivals::Next() {
  if (kind_ == ArrivalKind::kConstant) {
    return Seconds(static_cast<double>(calls_++) / rate_hz_);  // a product, since a sum would drift
  }
  seconds_ -= std::log(random_.OpenUniform()) / rate_hz_;
  return Seconds(seconds_);
}

}  // namespace duet::contrib::load
