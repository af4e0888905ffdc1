#ifndef DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_
#define DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/checkpoint/architecture.h"
#include "model/motion/standardise.h"

// Architectures and the names of choices as JSON, in manifests and training configurations. Only
// the code that reads or writes those files needs it.
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

// Reads an object in the field `key`: calls `read(fields)` with its reader, and records its errors.
template <typename Read>
void ReadSection(base::ObjectReader* reader, const std::string& key, const Read& read) {
  const nlohmann::json& object = reader->Object(key);
  if (!reader->ok()) return;
  base::ObjectReader fields(object, reader->PathOf(key));
  read(&fields);
  reader->Update(fields.Finish());
}

// The field of a JSON object that names its architecture.
inline constexpr char kArchitectureKind[] = "kind";

// Reads the fields of "generator". An object without a kind is the paper's: version 1 of the
// format had no other, and training configurations may omit it. Errors are recorded in the reader.
Architecture ReadArchitecture(bool has_kind, base::ObjectReader* reader);

// Includes the kind.
nlohmann::ordered_json ToJson(const Architecture& architecture);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_
