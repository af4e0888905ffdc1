#ifndef DUET_MODEL_ENGINE_CAPTURE_FITS_H_
#define DUET_MODEL_ENGINE_CAPTURE_FITS_H_

#include <optional>
#include <vector>

#include "model/engine/model_description.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// What captured pairs show about how people meet, for a model's description. World metres, y up.
namespace duet::engine {

// Frames [begin, end) of a captured pair.
struct Stretch {
  const motion::Poses* leader = nullptr;
  const motion::Poses* follower = nullptr;
  int begin = 0;
  int end = 0;
};
using Stretches = std::vector<Stretch>;

// Whether people meet a hand that their partner offers, in stretches of one class: the lower
// quartile of the distances of hands that meet. Absent if the leaders offer a hand for less than
// 3 s, if less than three tenths of an offered hand's time is met in the mean of the stretches, or
// without two named arms.
std::optional<double> HandContactMetres(const motion::Skeleton& skeleton,
                                        const Stretches& stretches, double frame_rate_hz);

// The hands of followers that rest on their partner's trunk, in stretches of one class: those that
// are at the trunk for at least a fifth of the time in which both people are close, if that is 3 s
// or more. The place is the median one. `interaction_class` is left empty.
std::vector<TrunkContact> TrunkContacts(const motion::Skeleton& skeleton,
                                        const Stretches& stretches, double frame_rate_hz);

// Whether followers face their leaders, in stretches of one class: how far they are turned away at
// most, nine tenths of the time. Absent if that is so far that they do not, for less than 3 s, and
// for a skeleton without hips or two named shoulders.
std::optional<double> FacingDegrees(const motion::Skeleton& skeleton, const Stretches& stretches,
                                    double frame_rate_hz);

// For each bone of the skeleton, the median of its length in the followers, as a multiple of the
// leader's. Empty unless in nine of ten pairs the followers are smaller, or in nine of ten larger,
// by at least 2 %: otherwise they are as different as any two people.
std::vector<double> BoneRatios(const motion::Skeleton& skeleton, const Stretches& pairs);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CAPTURE_FITS_H_
