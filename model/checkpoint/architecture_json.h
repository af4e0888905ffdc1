#ifndef DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_
#define DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
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

// The fields of an object, which declare themselves once, for reading and for writing it:
//
//   fields->Section("drift", [&] {
//     fields->Share("share", &drift->share);
//     fields->Number("tilt", 0, 4, &drift->tilt);
//   });
class Fields {
 public:
  // Reads the values. Errors are recorded in `reader`.
  explicit Fields(base::ObjectReader* reader) : reader_(reader) {}
  // Adds the values to an object.
  explicit Fields(nlohmann::ordered_json* object) : object_(object) {}

  // Whether there is a field of this name. Fields that files of earlier versions lack are declared
  // only if there is one.
  bool Has(const std::string& name) const { return reader_ == nullptr || reader_->Has(name); }
  // Whether values are read, all of them well so far, so that they can be compared; and an error
  // found by that.
  bool ReadsWell() const { return reader_ != nullptr && reader_->ok(); }
  void Fail(const std::string& name, const std::string& problem) { reader_->Fail(name, problem); }

  void Number(const std::string& name, double min, double max, double* value) {
    if (reader_ != nullptr) *value = reader_->Number(name, min, max);
    Write(name, *value);
  }
  // A probability, or a part of a whole.
  void Share(const std::string& name, double* value) { Number(name, 0, 1, value); }
  template <typename Integer>
  void Int(const std::string& name, int64_t min, int64_t max, Integer* value) {
    if (reader_ != nullptr) *value = static_cast<Integer>(reader_->Int(name, min, max));
    Write(name, *value);
  }
  void Bool(const std::string& name, bool* value) {
    if (reader_ != nullptr) *value = reader_->Bool(name);
    Write(name, *value);
  }
  // One that is absent where it is false.
  void OptionalBool(const std::string& name, bool* value) {
    if (reader_ != nullptr ? reader_->Has(name) : *value) Bool(name, value);
  }
  // One of the names of a table of Named.
  template <typename Table, typename Value>
  void Choice(const std::string& name, const Table& table, Value* value) {
    if (reader_ != nullptr) *value = ReadNamed(reader_, name, table);
    Write(name, std::string(NameOf(table, *value)));
  }
  // One of several words.
  void Word(const std::string& name, const std::vector<std::string>& choices, std::string* value) {
    constexpr std::size_t kMaxBytes = 64;
    if (reader_ != nullptr) *value = reader_->String(name, kMaxBytes);
    if (ReadsWell() && std::find(choices.begin(), choices.end(), *value) == choices.end()) {
      Fail(name, absl::StrCat("expected one of ", absl::StrJoin(choices, ", "), ", got ",
                              base::Quoted(*value)));
    }
    Write(name, *value);
  }
  void Words(const std::string& name, std::vector<std::string>* values) {
    constexpr std::size_t kMostWords = 256;
    if (reader_ != nullptr) *values = reader_->Strings(name, kMostWords);
    Write(name, *values);
  }

  // Declares the fields of the object `name` with `declare()`.
  template <typename Declare>
  void Section(const std::string& name, const Declare& declare) {
    if (reader_ != nullptr) {
      ReadSection(reader_, name, [&](base::ObjectReader* section) {
        base::ObjectReader* const outer = std::exchange(reader_, section);
        declare();
        reader_ = outer;
      });
    } else {
      nlohmann::ordered_json* const outer = std::exchange(object_, &(*object_)[name]);
      declare();
      object_ = outer;
    }
  }

 private:
  template <typename Value>
  void Write(const std::string& name, const Value& value) {
    if (object_ != nullptr) (*object_)[name] = value;
  }

  base::ObjectReader* reader_ = nullptr;  // of the current section, as the object
  nlohmann::ordered_json* object_ = nullptr;
};

// The field of a JSON object that names its architecture.
inline constexpr char kArchitectureKind[] = "kind";

// Reads the fields of "generator". An object without a kind is the paper's: version 1 of the
// format had no other, and training configurations may omit it. Errors are recorded in the reader.
Architecture ReadArchitecture(bool has_kind, base::ObjectReader* reader);

// Includes the kind.
nlohmann::ordered_json ToJson(const Architecture& architecture);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_
