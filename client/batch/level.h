#ifndef DUET_CLIENT_BATCH_LEVEL_H_
#define DUET_CLIENT_BATCH_LEVEL_H_

#include <functional>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/leader_source.h"
#include "client/batch/recipe.h"
#include "model/motion/skeleton.h"
#include "model/motion/vertical.h"

namespace duet::client::batch {

// "auto", "off" or "X,Y,Z": the vertical in metres, y up, less than 45 degrees from +y.
inline constexpr char kLevelForm[] = "auto|off|X,Y,Z";
absl::StatusOr<Level> ParseLevel(absl::string_view text);

// What follows from an estimate, or from a level that is not automatic: SynthesisOptions::up, and a
// line that says why, which is empty if levelling is off.
struct Levelled {
  std::optional<motion::Vec3> up;
  std::string note;
};
Levelled LevelBy(const motion::VerticalEstimate& estimate);
Levelled LevelBy(const Level& given);

// Estimates the vertical of the camera that captured all leaders, from all people in at most the
// first 1000 files. Files that cannot be read and bad lines are skipped: the check of the plan
// reports them. `stopped` is called between files; once it returns true, the estimate ends.
motion::VerticalEstimate EstimateVertical(const LeaderInput& input,
                                          const motion::Skeleton& skeleton, LeaderSource* leaders,
                                          const std::function<bool()>& stopped);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEVEL_H_
