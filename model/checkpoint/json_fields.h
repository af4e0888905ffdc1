#ifndef DUET_MODEL_CHECKPOINT_JSON_FIELDS_H_
#define DUET_MODEL_CHECKPOINT_JSON_FIELDS_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/checkpoint/architecture.h"
#include "model/motion/standardise.h"

// Manifests as JSON, and what training configurations share with them: architectures and the names
// of choices. Only the code that reads or writes those files needs it.
namespace duet::checkpoint {

template <typename T>
struct Named {
  std::string_view name;
  T value;
};

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

// The fields of an object, which declare themselves once, for reading and for writing it, in the
// order in which they are written:
//
//   fields->Section("noise", [&] {
//     fields->Share("constant_share", &noise->constant_share);
//     fields->Number("white", 0, 10, &noise->white);
//   });
class Fields {
 public:
  // Reads the values. Errors are recorded in `reader`.
  explicit Fields(base::ObjectReader* reader) : reader_(reader) {}
  // Adds the values to an object.
  explicit Fields(nlohmann::ordered_json* object) : object_(object) {}

  // The reader of the current section; null if values are written. And a value to write, which is
  // ignored if values are read. For fields of other kinds than below.
  base::ObjectReader* reader() { return reader_; }
  template <typename Value>
  void Write(const std::string& name, const Value& value) {
    if (object_ != nullptr) (*object_)[name] = value;
  }

  // Whether an optional field is there: in the file that is read, or because the one that is
  // written needs it.
  bool Optional(const std::string& name, bool is_needed) const {
    return reader_ != nullptr ? reader_->Has(name) : is_needed;
  }
  // Whether values are read, all of them well so far, so that they can be compared; and an error
  // found by that.
  bool ReadsWell() const { return reader_ != nullptr && reader_->ok(); }
  void Fail(const std::string& name, const std::string& problem) { reader_->Fail(name, problem); }

  template <typename Real>
  void Number(const std::string& name, double min, double max, Real* value) {
    if (reader_ != nullptr) *value = static_cast<Real>(reader_->Number(name, min, max));
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
    if (Optional(name, *value)) Bool(name, value);
  }
  void Text(const std::string& name, std::size_t max_bytes, std::string* value) {
    if (reader_ != nullptr) *value = reader_->String(name, max_bytes);
    Write(name, *value);
  }
  // At most `max_count` different texts.
  void Texts(const std::string& name, std::size_t max_count, std::size_t max_bytes,
             std::vector<std::string>* values) {
    if (reader_ != nullptr) *values = reader_->UniqueStrings(name, max_count, max_bytes);
    Write(name, *values);
  }
  // Exactly `count` numbers; `each` says for what.
  void Numbers(const std::string& name, std::size_t count, const char* each, double min, double max,
               std::vector<double>* values) {
    if (reader_ != nullptr) *values = ReadNumbers(name, count, each, min, max);
    Write(name, *values);
  }
  // One of the names of a table of Named.
  template <typename Table, typename Value>
  void Choice(const std::string& name, const Table& table, Value* value) {
    if (reader_ != nullptr) *value = ReadNamed(reader_, name, table);
    Write(name, std::string(NameOf(table, *value)));
  }

  // Declares the fields of the object `name` with `declare()`.
  template <typename Declare>
  void Section(const std::string& name, const Declare& declare) {
    if (reader_ != nullptr) {
      ReadSection(reader_, name,
                  [&](base::ObjectReader* section) { Within(&reader_, section, declare); });
    } else {
      nlohmann::ordered_json& section = (*object_)[name] = nlohmann::ordered_json::object();
      Within(&object_, &section, declare);
    }
  }
  // Declares the objects of an array of at most `max_count`, each with `declare(&value)`.
  template <typename Value, typename Declare>
  void List(const std::string& name, std::size_t max_count, std::vector<Value>* values,
            const Declare& declare) {
    if (reader_ != nullptr) {
      for (const nlohmann::json& item : reader_->Array(name, max_count)) {
        base::ObjectReader element(item,
                                   reader_->PathOf(absl::StrCat(name, "[", values->size(), "]")));
        Value* const value = &values->emplace_back();
        if (element.ok()) Within(&reader_, &element, [&] { declare(value); });
        reader_->Update(element.Finish());
      }
    } else {
      nlohmann::ordered_json array = nlohmann::ordered_json::array();
      for (Value& value : *values) {
        Within(&object_, &array.emplace_back(), [&] { declare(&value); });
      }
      (*object_)[name] = std::move(array);
    }
  }
  // The names of the fields of the object `name` that is read, at most `max_count`.
  std::vector<std::string> NamesIn(const std::string& name, std::size_t max_count) {
    std::vector<std::string> names;
    if (reader_ == nullptr) return names;
    for (const auto& field : reader_->Object(name).items()) names.push_back(field.key());
    if (names.size() > max_count) Fail(name, "too many entries");
    return names;
  }

 private:
  template <typename Place, typename Declare>
  static void Within(Place** current, Place* section, const Declare& declare) {
    Place* const outer = std::exchange(*current, section);
    declare();
    *current = outer;
  }

  std::vector<double> ReadNumbers(const std::string& name, std::size_t count, const char* each,
                                  double min, double max) {
    std::vector<double> numbers;
    for (const nlohmann::json& value : reader_->Array(name, count)) {
      const std::string element = absl::StrCat(name, "[", numbers.size(), "]");
      numbers.push_back(value.is_number() ? value.get<double>() : std::nan(""));
      if (!(numbers.back() >= min && numbers.back() <= max)) {
        Fail(element, absl::StrCat("expected a number from ", min, " to ", max, ", got ",
                                   base::Shown(value)));
      }
    }
    if (reader_->ok() && numbers.size() != count) {
      Fail(name, absl::StrCat("expected ", count, " numbers (", each, "), got ", numbers.size()));
    }
    return numbers;
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

#endif  // DUET_MODEL_CHECKPOINT_JSON_FIELDS_H_
