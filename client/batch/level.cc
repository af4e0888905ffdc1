#include "client/batch/level.h"

#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/batch/text_values.h"
#include "model/base/angle.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

constexpr std::size_t kMostFiles = 1000;
constexpr float kMinUprightCosine = 0.70710678f;  // of 45 degrees

void AddPeople(const std::filesystem::path& file, formats::ReadOptions options,
               motion::VerticalEvidence* evidence) {
  retargeting::ReadingReport report;
  options.report = &report;
  for (const formats::Side side : {formats::Side::kLeft, formats::Side::kRight}) {
    options.side = side;
    const absl::StatusOr<motion::Clip> person = formats::ReadLeader(file, options);
    if (!person.ok()) return;
    evidence->Add(*person);
    if (report.people < 2) return;
  }
}

}  // namespace

absl::StatusOr<Level> ParseLevel(absl::string_view text) {
  if (text == "auto") return Level{};
  if (text == "off") return Level{false, std::nullopt};
  const std::optional<motion::Vec3> up = ParsePoint(text);
  if (up.has_value() && IsFinite(*up) && up->y > kMinUprightCosine * Norm(*up)) {
    return Level{false, up};
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "expected auto, off or X,Y,Z less than 45 degrees from 0,1,0, got ", base::Quoted(text)));
}

Levelled LevelBy(const motion::VerticalEstimate& estimate) {
  const std::string found = Describe(estimate);
  if (estimate.verdict == motion::TiltVerdict::kTilted) {
    return {estimate.up, absl::StrCat("levelled: ", found)};
  }
  return {std::nullopt, absl::StrCat("not levelled: ", found)};
}

Levelled LevelBy(const Level& given) {
  if (!given.up.has_value()) return {};
  const motion::Vec3& up = *given.up;
  const double degrees = base::kDegreesPerRadian * std::atan2(std::hypot(up.x, up.z), up.y);
  return {up, absl::StrFormat("levelled: tilted by %.1f degrees, as --level states", degrees)};
}

motion::VerticalEstimate EstimateVertical(const LeaderInput& input,
                                          const motion::Skeleton& skeleton, LeaderSource* leaders,
                                          const std::function<bool()>& stopped) {
  motion::VerticalEvidence evidence(skeleton);
  formats::ReadOptions options = input.reading;
  options.skeleton = skeleton;
  std::set<std::filesystem::path> seen;
  while (seen.size() < kMostFiles && !stopped()) {
    const absl::StatusOr<std::optional<LeaderEntry>> entry = leaders->Next();
    if (absl::IsInvalidArgument(entry.status())) continue;
    if (!entry.ok() || !entry->has_value()) break;
    if (seen.insert((*entry)->file).second) AddPeople((*entry)->file, options, &evidence);
  }
  return evidence.Estimate();
}

}  // namespace duet::client::batch
