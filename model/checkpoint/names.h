#ifndef DUET_MODEL_CHECKPOINT_NAMES_H_
#define DUET_MODEL_CHECKPOINT_NAMES_H_

#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/checkpoint/architecture.h"
#include "model/motion/standardise.h"

// The names of choices in manifests and training configurations. Only code that reads or writes
// those files needs them.
namespace duet::checkpoint {

template <typename T>
struct Named {
  std::string_view name;
  T value;
};

inline constexpr Named<GeneratorVariant> kVariantNames[] = {
    {"paper", GeneratorVariant::kPaper},
    {"released", GeneratorVariant::kReleased},
    {"unlabelled", GeneratorVariant::kUnlabelled}};

inline constexpr Named<motion::StandardOrigin> kStandardisationNames[] = {
    {"leader_root_and_yaw", motion::StandardOrigin::kEveryFrame},
    {"leader_start_and_yaw", motion::StandardOrigin::kFirstFrame}};

// Requires a value of the table.
template <typename T, std::size_t n>
std::string_view NameOf(const Named<T> (&table)[n], T value) {
  for (const Named<T>& row : table) {
    if (row.value == value) return row.name;
  }
  return {};
}

// The value whose name the field contains. For any other text, records the names of the table as an
// error and returns the first value.
template <typename Table>
auto ReadNamed(base::ObjectReader* reader, const std::string& key, const Table& table) {
  constexpr std::size_t kMaxBytes = 4096;
  const std::string name = reader->String(key, kMaxBytes);
  std::string wanted;
  std::size_t left = std::size(table);
  for (const auto& row : table) {
    if (row.name == name) return row.value;
    --left;
    absl::StrAppend(&wanted, "\"", std::string(row.name), "\"",
                    left > 1    ? ", "
                    : left == 1 ? " or "
                                : "");
  }
  reader->Fail(key, absl::StrCat("expected ", wanted, ", got ", base::Quoted(name)));
  return std::begin(table)->value;
}

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_NAMES_H_
