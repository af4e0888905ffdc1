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

// The most values (objects, arrays, strings, numbers, ...) of a document that is held whole: "[],"
// is 3 bytes of text and about 50 in memory.
inline constexpr std::size_t kMaxJsonValues = 2'000'000;

// Parses untrusted JSON text. On top of the JSON grammar: the root is an object and the very first
// byte its brace, no object repeats a key, nothing is nested deeper than `max_depth`, there are at
// most kMaxJsonValues values, and there is no NUL byte. Never throws.
absl::StatusOr<nlohmann::json> ParseStrictJson(std::string_view text, int max_depth);

// The same for a document that people write: it may begin with a byte order mark and blanks.
absl::StatusOr<nlohmann::json> ParseHandwrittenJson(absl::string_view text, int max_depth);

// The same for a document of any number of values, of which nothing is held in memory that lies
// within the root's fields `skipped`: of these, arrays and objects come back empty.
absl::StatusOr<nlohmann::json> ParseHandwrittenJson(absl::string_view text, int max_depth,
                                                    const std::set<std::string>& skipped);

// A value as a message shows it: a string as Quoted has it, other short values as they are written,
// a long array or object by its size.
std::string Shown(const nlohmann::json& value);

// Reads an object field by field and remembers the first thing that was wrong, so that reading code
// is a plain list of fields:
//
//   ObjectReader reader(json, "generator");
//   generator.attention = reader.Int("attention", 1, 4096);
//   ...
//   return reader.Finish();        // also refuses fields that nobody asked for
//
// A getter whose field is missing, mistyped or out of range returns an empty value.
class ObjectReader {
 public:
  // `path` names the object in messages; empty for the root. `object` must outlive the reader.
  ObjectReader(const nlohmann::json& object, std::string path);

  std::string String(const std::string& key, std::size_t max_bytes);
  bool Bool(const std::string& key);
  int64_t Int(const std::string& key, int64_t min, int64_t max);
  double Number(const std::string& key, double min, double max);
  // A string that `parse` knows; `wanted` tells people which. The first value of the type
  // otherwise.
  template <typename Value>
  Value Choice(const std::string& key, std::optional<Value> (*parse)(absl::string_view),
               absl::string_view wanted) {
    const nlohmann::json* value = Get(key);
    if (value == nullptr) return {};
    std::optional<Value> choice;
    if (value->is_string()) choice = parse(value->get_ref<const std::string&>());
    if (!choice.has_value()) FailType(key, *value, wanted);
    return choice.value_or(Value{});
  }
  // An array of at most `max_count` non-empty strings.
  std::vector<std::string> Strings(const std::string& key, std::size_t max_count);
  // An array of at most `max_count` values of any type, or an empty array.
  const nlohmann::json& Array(const std::string& key, std::size_t max_count);
  // An object, or an empty object.
  const nlohmann::json& Object(const std::string& key);

  bool Has(const std::string& key) const { return object_.contains(key); }
  // "generator.attention", for messages.
  std::string PathOf(const std::string& key) const;
  // Records a failure found outside the reader, if it is the first.
  void Fail(const std::string& key, const std::string& problem);
  void Update(const absl::Status& status);

  bool ok() const { return status_.ok(); }
  // The first problem so far. Enough by itself where fields that nobody asked for are no problem.
  const absl::Status& status() const { return status_; }
  absl::Status Finish();

 private:
  // The field's value, or null after recording that it is missing.
  const nlohmann::json* Get(const std::string& key);
  void FailType(const std::string& key, const nlohmann::json& value, absl::string_view wanted);

  const nlohmann::json& object_;
  std::string path_;
  std::set<std::string> asked_;
  absl::Status status_;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_STRICT_JSON_H_
