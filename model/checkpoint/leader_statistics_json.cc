#include "model/checkpoint/leader_statistics_json.h"

#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/engine/leader_features.h"

namespace duet::checkpoint {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using Feature = engine::LeaderStatistics::Feature;

// Far above any person, and low enough that squares and sums cannot overflow.
constexpr double kMost = 1e6;
constexpr double kLeast = 1e-6;
constexpr std::size_t kMaxNameBytes = 64;

Feature ReadFeature(base::ObjectReader* fields, const std::vector<engine::LeaderFeature>& known,
                    std::set<std::string>* seen) {
  Feature feature;
  feature.name = fields->String("name", kMaxNameBytes);
  feature.mean = fields->Number("mean", -kMost, kMost);
  feature.deviation = fields->Number("deviation", kLeast, kMost);
  if (!seen->insert(feature.name).second) {
    fields->Fail("name", absl::StrCat(json(feature.name).dump(), " is repeated"));
  }
  std::string names;
  for (const engine::LeaderFeature& one : known) {
    if (one.name == feature.name) return feature;
    absl::StrAppend(&names, names.empty() ? "" : ", ", std::string(one.name));
  }
  fields->Fail("name",
               absl::StrCat("expected one of ", names, ", got ", json(feature.name).dump()));
  return feature;
}

}  // namespace

absl::StatusOr<engine::LeaderStatistics> ReadLeaderStatistics(const json& value,
                                                              const motion::Skeleton& skeleton,
                                                              const std::string& path) {
  base::ObjectReader reader(value, path);
  engine::LeaderStatistics statistics;
  const std::vector<engine::LeaderFeature> known = engine::LeaderFeatures(skeleton);
  std::set<std::string> seen;
  for (const json& item : reader.Array("features", known.size())) {
    base::ObjectReader fields(
        item, reader.PathOf(absl::StrCat("features[", statistics.features.size(), "]")));
    statistics.features.push_back(ReadFeature(&fields, known, &seen));
    reader.Update(fields.Finish());
  }
  if (reader.ok() && statistics.features.empty()) {
    reader.Fail("features", "expected at least one feature, got none");
  }
  statistics.scale = reader.Number("scale", kLeast, kMost);
  if (absl::Status status = reader.Finish(); !status.ok()) return status;
  return statistics;
}

ordered_json LeaderStatisticsToJson(const engine::LeaderStatistics& statistics) {
  ordered_json features = ordered_json::array();
  for (const Feature& feature : statistics.features) {
    features.push_back(
        {{"name", feature.name}, {"mean", feature.mean}, {"deviation", feature.deviation}});
  }
  return {{"features", features}, {"scale", statistics.scale}};
}

}  // namespace duet::checkpoint
