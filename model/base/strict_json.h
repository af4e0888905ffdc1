#ifndef DUET_MODEL_BASE_STRICT_JSON_H_
#define DUET_MODEL_BASE_STRICT_JSON_H_

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::base {

// Maximum number of values (objects, arrays, strings, numbers, ...) of a document in memory: "[],"
// is 3 bytes of text and about 50 bytes in memory.
inline constexpr std::size_t kMaxJsonValues = 2'000'000;

// Parses untrusted JSON text. In addition to the JSON grammar: the root is an object and its brace
// is the first byte, no object repeats a key, the nesting depth is at most `max_depth`, there are
// at most kMaxJsonValues values, and there is no NUL byte. Never throws.
absl::StatusOr<nlohmann::json> ParseStrictJson(std::string_view text, int max_depth);

// Parses a handwritten document, which may also begin with a byte order mark and white space.
absl::StatusOr<nlohmann::json> ParseHandwrittenJson(absl::string_view text, int max_depth);

// Parses a handwritten document with any number of values. The content of the root's fields
// `skipped` is checked but not stored: their arrays and objects are empty in the result.
absl::StatusOr<nlohmann::json> ParseHandwrittenJson(absl::string_view text, int max_depth,
                                                    const std::set<std::string>& skipped);

// Formats a value for a message: a string like Quoted, a long array or object as its size, other
// values as JSON.
std::string Shown(const nlohmann::json& value);

// Reads an object field by field and keeps the first error, so that reading code is a plain list of
// fields:
//
//   ObjectReader reader(json, "generator");
//   generator.attention = reader.Int("attention", 1, 4096);
//   ...
//   return reader.Finish();        // also rejects fields that were not read
//
// A getter returns an empty value if its field is missing, has another type or is out of range.
class ObjectReader {
 public:
  // `path` names the object in messages; empty for the root. `object` must outlive the reader.
  ObjectReader(const nlohmann::json& object, std::string path);

  std::string String(const std::string& key, std::size_t max_bytes);
  bool Bool(const std::string& key);
  int64_t Int(const std::string& key, int64_t min, int64_t max);
  double Number(const std::string& key, double min, double max);
  // A string that `parse` accepts; `expected` lists these for messages. Returns Value{} otherwise.
  template <typename Value>
  Value Choice(const std::string& key, std::optional<Value> (*parse)(absl::string_view),
               absl::string_view expected) {
    const nlohmann::json* value = Get(key);
    if (value == nullptr) return {};
    std::optional<Value> choice;
    if (value->is_string()) choice = parse(value->get_ref<const std::string&>());
    if (!choice.has_value()) FailType(key, *value, expected);
    return choice.value_or(Value{});
  }
  // An array of at most `max_count` non-empty strings.
  std::vector<std::string> Strings(const std::string& key, std::size_t max_count);
  // The same for different strings of at most `max_bytes` each.
  std::vector<std::string> UniqueStrings(const std::string& key, std::size_t max_count,
                                         std::size_t max_bytes);
  // An array of at most `max_count` values of any type, or an empty array.
  const nlohmann::json& Array(const std::string& key, std::size_t max_count);
  // An object, or an empty object.
  const nlohmann::json& Object(const std::string& key);

  bool Has(const std::string& key) const { return object_.contains(key); }
  // Accepts a field of any value, which nothing reads.
  void Ignore(const std::string& key) { asked_.insert(key); }
  // "generator.attention", for messages.
  std::string PathOf(const std::string& key) const;
  // Records an error found by the caller, unless there is one already.
  void Fail(const std::string& key, const std::string& problem);
  void Update(const absl::Status& status);

  bool ok() const { return status_.ok(); }
  // The first error so far. Use it instead of Finish() if unknown fields are allowed.
  const absl::Status& status() const { return status_; }
  absl::Status Finish();

 private:
  // The field's value. Records an error and returns null if it is missing.
  const nlohmann::json* Get(const std::string& key);
  void FailType(const std::string& key, const nlohmann::json& value, absl::string_view expected);

  const nlohmann::json& object_;
  std::string path_;
  std::set<std::string> asked_;
  absl::Status status_;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_STRICT_JSON_H_
