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

}  // namespace

std::optional<engine::DirectionRegression> ReadDirectionRegression(const motion::Skeleton& skeleton,
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
  regression.mean = ReadNumbers(&reader, "mean", count, -kLargest);
  regression.deviation = ReadNumbers(&reader, "deviation", count, kSmallestDeviation);
  regression.cosine = ReadNumbers(&reader, "cosine", count, -kLargest);
  regression.sine = ReadNumbers(&reader, "sine", count, -kLargest);
  manifest->Update(reader.Finish());
  return regression;
}

nlohmann::ordered_json DirectionRegressionToJson(const engine::DirectionRegression& regression) {
  return {{"mean", regression.mean},
          {"deviation", regression.deviation},
          {"cosine", regression.cosine},
          {"sine", regression.sine}};
}

}  // namespace duet::checkpoint
