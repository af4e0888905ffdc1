#include "model/authoring/monotone_cubic.h"

#include <algorithm>
#include <utility>

namespace duet::authoring {

MonotoneCubic::MonotoneCubic(std::vector<Key> keys)
    : keys_(std::move(keys)), slopes_(keys_.size(), 0.0) {
  for (std::size_t k = 1; k + 1 < keys_.size(); ++k) {
    const double before =
        (keys_[k].value - keys_[k - 1].value) / (keys_[k].time - keys_[k - 1].time);
    const double after =
        (keys_[k + 1].value - keys_[k].value) / (keys_[k + 1].time - keys_[k].time);
    // Zero at a turning point; elsewhere the harmonic mean, which the flatter side dominates.
    if (before * after > 0) slopes_[k] = 2 * before * after / (before + after);
  }
}

double MonotoneCubic::At(double time) const {
  if (time <= keys_.front().time) return keys_.front().value;
  if (time >= keys_.back().time) return keys_.back().value;
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                      [](double t, const Key& key) { return t < key.time; });
  const std::size_t k = static_cast<std::size_t>(after - keys_.begin()) - 1;
  const Key& a = keys_[k];
  const Key& b = keys_[k + 1];
  const double span = b.time - a.time, t = (time - a.time) / span;
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * a.value + (t3 - 2 * t2 + t) * span * slopes_[k] +
         (3 * t2 - 2 * t3) * b.value + (t3 - t2) * span * slopes_[k + 1];
}

}  // namespace duet::authoring
