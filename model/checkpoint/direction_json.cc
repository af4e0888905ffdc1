#include "model/checkpoint/direction_json.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"

namespace duet::checkpoint {
namespace {

using nlohmann::json;

// Far above any fit, and low enough that products and sums cannot overflow.
constexpr double kLargest = 1e6;
constexpr double kSmallestDeviation = 1e-6;

std::vector<double> ReadNumbers(base::ObjectReader* reader, const std::string& key, int count,
                                double smallest) {
  const std::size_t wanted = static_cast<std::size_t>(count);
  const json& array = reader->Array(key, wanted);
  std::vector<double> numbers;
  for (const json& value : array) {
    const std::string element = absl::StrCat(key, "[", numbers.size(), "]");
    numbers.push_back(value.is_number() ? value.get<double>() : std::nan(""));
    if (!(numbers.back() >= smallest && numbers.back() <= kLargest)) {
      reader->Fail(element, absl::StrCat("expected a number from ", smallest, " to ", kLargest,
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
  *cosine = ReadNumbers(reader, "cosine", count, -kLargest);
  *sine = ReadNumbers(reader, "sine", count, -kLargest);
}

void ReadAngleRegression(base::ObjectReader* reader, int count,
                         engine::AngleRegression* regression) {
  regression->mean = ReadNumbers(reader, "mean", count, -kLargest);
  regression->deviation = ReadNumbers(reader, "deviation", count, kSmallestDeviation);
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

nlohmann::ordered_json ToJson(const engine::AngleRegression& regression) {
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

nlohmann::ordered_json DirectionRegressionToJson(const engine::DirectionRegression& regression) {
  nlohmann::ordered_json object = ToJson(regression);
  if (!regression.correction) return object;
  object["correction"] = ToJson(*regression.correction);
  nlohmann::ordered_json& classes = object["correction"]["classes"] =
      nlohmann::ordered_json::array();
  for (const engine::ClassCoefficients& added : regression.correction->classes) {
    classes.push_back({{"cosine", added.cosine}, {"sine", added.sine}});
  }
  return object;
}

}  // namespace duet::checkpoint
