#include "model/checkpoint/leader_json.h"

#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/engine/leader_statistics.h"

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

namespace {

std::vector<double> ReadNumbers(base::ObjectReader* reader, const std::string& key, int count,
                                double smallest) {
  const std::size_t wanted = static_cast<std::size_t>(count);
  const json& array = reader->Array(key, wanted);
  std::vector<double> numbers;
  for (const json& value : array) {
    const std::string element = absl::StrCat(key, "[", numbers.size(), "]");
    numbers.push_back(value.is_number() ? value.get<double>() : std::nan(""));
    if (!(numbers.back() >= smallest && numbers.back() <= kMost)) {
      reader->Fail(element, absl::StrCat("expected a number from ", smallest, " to ", kMost,
                                         ", got ", base::Shown(value)));
    }
  }
  if (reader->ok() && numbers.size() != wanted) {
    reader->Fail(
        key, absl::StrCat("expected ", wanted, " numbers (two for each joint, three more), got ",
                          numbers.size()));
  }
  return numbers;
}

void ReadCoefficients(base::ObjectReader* reader, int count, std::vector<double>* cosine,
                      std::vector<double>* sine) {
  *cosine = ReadNumbers(reader, "cosine", count, -kMost);
  *sine = ReadNumbers(reader, "sine", count, -kMost);
}

void ReadAngleRegression(base::ObjectReader* reader, int count,
                         engine::AngleRegression* regression) {
  regression->mean = ReadNumbers(reader, "mean", count, -kMost);
  regression->deviation = ReadNumbers(reader, "deviation", count, kLeast);
  ReadCoefficients(reader, count, &regression->cosine, &regression->sine);
}

engine::DirectionCorrection ReadCorrection(base::ObjectReader* direction, int count, int classes) {
  base::ObjectReader reader(direction->Object("correction"), "partner_direction.correction");
  engine::DirectionCorrection correction;
  ReadAngleRegression(&reader, count, &correction);
  const json& list = reader.Array("classes", static_cast<std::size_t>(classes));
  for (const json& value : list) {
    const std::string name =
        absl::StrCat("partner_direction.correction.classes[", correction.classes.size(), "]");
    if (!value.is_object()) {
      reader.Fail("classes", absl::StrCat("expected objects, got ", base::Shown(value)));
      break;
    }
    base::ObjectReader item(value, name);
    engine::ClassCoefficients& added = correction.classes.emplace_back();
    ReadCoefficients(&item, count, &added.cosine, &added.sine);
    reader.Update(item.Finish());
  }
  if (reader.ok() && list.size() != static_cast<std::size_t>(classes)) {
    reader.Fail("classes", absl::StrCat("expected one object for each of the ", classes,
                                        " classes, got ", list.size()));
  }
  direction->Update(reader.Finish());
  return correction;
}

ordered_json ToJson(const engine::AngleRegression& regression) {
  return {{"mean", regression.mean},
          {"deviation", regression.deviation},
          {"cosine", regression.cosine},
          {"sine", regression.sine}};
}

}  // namespace

std::optional<engine::DirectionRegression> ReadDirectionRegression(const motion::Skeleton& skeleton,
                                                                   int classes,
                                                                   base::ObjectReader* manifest) {
  if (!manifest->ok() || !manifest->Has(kPartnerDirection)) return std::nullopt;
  const json& object = manifest->Object(kPartnerDirection);
  if (manifest->ok() && !skeleton.hips) {
    manifest->Fail(kPartnerDirection, "expected none for a skeleton without hips, got one");
  }
  if (!manifest->ok()) return std::nullopt;
  base::ObjectReader reader(object, kPartnerDirection);
  const int count = engine::DirectionFeatureCount(skeleton);
  engine::DirectionRegression regression;
  ReadAngleRegression(&reader, count, &regression);
  if (reader.Has("correction")) regression.correction = ReadCorrection(&reader, count, classes);
  manifest->Update(reader.Finish());
  return regression;
}

ordered_json DirectionRegressionToJson(const engine::DirectionRegression& regression) {
  ordered_json object = ToJson(regression);
  if (!regression.correction) return object;
  object["correction"] = ToJson(*regression.correction);
  ordered_json& classes = object["correction"]["classes"] = ordered_json::array();
  for (const engine::ClassCoefficients& added : regression.correction->classes) {
    classes.push_back({{"cosine", added.cosine}, {"sine", added.sine}});
  }
  return object;
}

}  // namespace duet::checkpoint
