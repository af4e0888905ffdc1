#ifndef DUET_MODEL_CHECKPOINT_NAMES_H_
#define DUET_MODEL_CHECKPOINT_NAMES_H_

#include <cstddef>
#include <optional>
#include <string_view>

#include "model/checkpoint/manifest.h"

// What manifests and training configurations call the choices that they make. Only the code that
// reads and writes those files needs it.
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

template <typename T, std::size_t n>
std::optional<T> ValueOf(const Named<T> (&table)[n], std::string_view name) {
  for (const Named<T>& row : table) {
    if (row.name == name) return row.value;
  }
  return std::nullopt;
}

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_NAMES_H_
