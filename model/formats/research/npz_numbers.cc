#include "model/formats/research/npz_numbers.h"

#include <cmath>
#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/formats/flat/npy_array.h"

namespace duet::formats::research {

absl::StatusOr<NpzNumbers> ReadNumbers(const NpzArchive& archive, absl::string_view name,
                                       double most) {
  const absl::StatusOr<std::string> bytes = archive.Read(name);
  if (!bytes.ok()) return bytes.status();
  NpzNumbers numbers;
  numbers.name = absl::StrCat(archive.source(), ": ", name);
  const absl::StatusOr<flat::NpyNumbers> array = flat::NpyNumbers::Parse(*bytes, numbers.name);
  if (!array.ok()) return array.status();
  numbers.shape = array->shape();
  numbers.values.reserve(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    const double value = array->at(i);
    if (!(std::abs(value) <= most)) {
      return absl::InvalidArgumentError(
          absl::StrCat(numbers.name, ": expected finite numbers within +-", most, ", got ", value));
    }
    numbers.values.push_back(value);
  }
  return numbers;
}

absl::Status WrongShape(const NpzNumbers& numbers, absl::string_view expected) {
  return absl::InvalidArgumentError(absl::StrCat(numbers.name, ": shape: expected ", expected,
                                                 ", got (", absl::StrJoin(numbers.shape, ", "),
                                                 ")"));
}

}  // namespace duet::formats::research
