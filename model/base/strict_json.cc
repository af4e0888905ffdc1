#include "model/base/strict_json.h"

#include <limits>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::base {
namespace {

constexpr std::size_t kLongestProblem = 1000;

using nlohmann::json;

// Arrays and objects with more items are shown by their size.
constexpr std::size_t kMostShownItems = 8;

// Builds the document that ParseStrictJson describes. The parser's own tree silently keeps the last
// of two equal keys; another reader that keeps the first would read a different document.
class StrictBuilder final : public nlohmann::json_sax<json> {
 public:
  // The content of the root's fields `skipped`, which must outlive this object, is not stored.
  StrictBuilder(int max_depth, std::size_t max_values, const std::set<std::string>& skipped)
      : max_depth_(max_depth), max_values_(max_values), skipped_(skipped) {}

  json Take() { return std::move(root_); }
  // Why the parser stopped.
  const std::string& problem() const { return problem_; }

  bool null() override { return Add(nullptr); }
  bool boolean(bool value) override { return Add(value); }
  bool number_integer(number_integer_t value) override { return Add(value); }
  bool number_unsigned(number_unsigned_t value) override { return Add(value); }
  bool number_float(number_float_t value, const string_t&) override { return Add(value); }
  bool string(string_t& value) override { return Add(std::move(value)); }
  bool binary(binary_t&) override { return Add(nullptr); }  // JSON has none
  bool start_object(std::size_t) override { return Open(json::object()); }
  bool start_array(std::size_t) override { return Open(json::array()); }
  bool end_object() override { return Close(); }
  bool end_array() override { return Close(); }

  bool key(string_t& name) override {
    if (++key_count_ > kMaxJsonValues) {
      return Fail(absl::StrCat("fields: expected at most ", kMaxJsonValues, " in one document"));
    }
    if (!keys_.back().insert(name).second) {
      return Fail(absl::StrCat("the field ", Quoted(name), " is repeated"));
    }
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const json::exception&) override {
    return Fail(absl::StrCat("not JSON at byte ", position));
  }

 private:
  bool Fail(std::string problem) {
    problem_ = std::move(problem);
    return false;
  }

  bool Count() {
    return ++values_ <= max_values_ ||
           Fail(absl::StrCat("values: expected at most ", max_values_, " in one document"));
  }

  // Where to store the next value; null within a skipped field.
  json* Place() {
    if (open_.empty()) return &root_;
    json* const parent = open_.back();
    if (parent == nullptr) return nullptr;
    if (parent->is_object()) return &(*parent)[key_];
    parent->push_back(nullptr);
    return &parent->back();
  }

  template <typename Value>
  bool Add(Value&& value) {
    if (!Count()) return false;
    if (json* const place = Place(); place != nullptr) *place = std::forward<Value>(value);
    return true;
  }

  bool Open(json empty) {
    if (!Count()) return false;
    if (static_cast<int>(open_.size()) == max_depth_) {
      return Fail(absl::StrCat("nested deeper than ", max_depth_, " levels"));
    }
    json* const place = Place();
    if (place != nullptr) *place = std::move(empty);
    const bool skips = open_.size() == 1 && skipped_.count(key_) > 0;
    open_.push_back(skips ? nullptr : place);
    keys_.emplace_back();
    return true;
  }

  bool Close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  const int max_depth_;
  const std::size_t max_values_;
  const std::set<std::string>& skipped_;
  std::size_t values_ = 0, key_count_ = 0;
  json root_;
  // Pointers stay valid: a container does not change while an inner one is open.
  std::vector<json*> open_;
  std::vector<std::set<std::string>> keys_;  // of every open object
  std::string key_;
  std::string problem_;
};

}  // namespace

std::string Shown(const json& value) {
  if (value.is_string()) return Quoted(value.get_ref<const std::string&>());
  if (value.is_structured() && value.size() > kMostShownItems) {
    return absl::StrCat("an ", value.type_name(), " of ", value.size());
  }
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > kLongestQuote) text = text.substr(0, kLongestQuote) + "...";
  return text;
}

namespace {

absl::StatusOr<json> Parse(std::string_view text, int max_depth, std::size_t max_values,
                           const std::set<std::string>& skipped) {
  if (text.empty() || text.front() != '{') {
    return absl::InvalidArgumentError("not a JSON object: expected '{' as the first byte");
  }
  // The parser treats a NUL as the end of the text and would ignore the rest.
  if (const std::size_t at = text.find('\0'); at != std::string_view::npos) {
    return absl::InvalidArgumentError(absl::StrCat("not JSON: a NUL at byte ", at));
  }
  StrictBuilder builder(max_depth, max_values, skipped);
  if (json::sax_parse(text.begin(), text.end(), &builder)) return builder.Take();
  return absl::InvalidArgumentError(builder.problem());
}

std::string_view SkipPrelude(absl::string_view text) {
  text = absl::StripLeadingAsciiWhitespace(SkipByteOrderMark(text));
  return {text.data(), text.size()};
}

}  // namespace

absl::StatusOr<json> ParseStrictJson(std::string_view text, int max_depth) {
  return Parse(text, max_depth, kMaxJsonValues, {});
}

absl::StatusOr<json> ParseHandwrittenJson(absl::string_view text, int max_depth) {
  return ParseStrictJson(SkipPrelude(text), max_depth);
}

absl::StatusOr<json> ParseHandwrittenJson(absl::string_view text, int max_depth,
                                          const std::set<std::string>& skipped) {
  return Parse(SkipPrelude(text), max_depth, std::numeric_limits<std::size_t>::max(), skipped);
}

ObjectReader::ObjectReader(const json& object, std::string path)
    : object_(object), path_(std::move(path)) {
  if (!object_.is_object()) {
    status_ = absl::InvalidArgumentError(
        absl::StrCat(path_, ": expected an object, got ", Shown(object_)));
  }
}

std::string ObjectReader::PathOf(const std::string& key) const {
  return path_.empty() ? key : absl::StrCat(path_, ".", key);
}

void ObjectReader::Fail(const std::string& key, const std::string& problem) {
  // The key and the problem may quote the file.
  Update(absl::InvalidArgumentError(
      Printable(absl::StrCat(PathOf(key), ": ", problem), kLongestProblem)));
}

void ObjectReader::Update(const absl::Status& status) { status_.Update(status); }

void ObjectReader::FailType(const std::string& key, const json& value, absl::string_view expected) {
  Fail(key, absl::StrCat("expected ", expected, ", got ", Shown(value)));
}

const json* ObjectReader::Get(const std::string& key) {
  asked_.insert(key);
  if (!object_.is_object()) return nullptr;
  const auto it = object_.find(key);
  if (it != object_.end()) return &*it;
  Fail(key, "missing");
  return nullptr;
}

std::string ObjectReader::String(const std::string& key, std::size_t max_bytes) {
  const json* value = Get(key);
  if (value == nullptr) return {};
  if (!value->is_string() || value->get_ref<const std::string&>().size() > max_bytes) {
    FailType(key, *value, absl::StrCat("a string of at most ", max_bytes, " bytes"));
    return {};
  }
  return value->get<std::string>();
}

bool ObjectReader::Bool(const std::string& key) {
  const json* value = Get(key);
  if (value == nullptr) return false;
  if (!value->is_boolean()) FailType(key, *value, "true or false");
  return value->is_boolean() && value->get<bool>();
}

int64_t ObjectReader::Int(const std::string& key, int64_t min, int64_t max) {
  const json* value = Get(key);
  if (value == nullptr) return 0;
  // An unsigned value beyond int64 would wrap to a negative one.
  const bool fits = value->is_number_unsigned()
                        ? value->get<uint64_t>() <= static_cast<uint64_t>(INT64_MAX)
                        : value->is_number_integer();
  const int64_t number = fits ? value->get<int64_t>() : 0;
  if (fits && number >= min && number <= max) return number;
  FailType(key, *value, absl::StrCat("a whole number from ", min, " to ", max));
  return 0;
}

double ObjectReader::Number(const std::string& key, double min, double max) {
  const json* value = Get(key);
  if (value == nullptr) return 0;
  const double number = value->is_number() ? value->get<double>() : 0;
  if (value->is_number() && number >= min && number <= max) return number;
  FailType(key, *value, absl::StrCat("a number from ", min, " to ", max));
  return 0;
}

std::vector<std::string> ObjectReader::Strings(const std::string& key, std::size_t max_count) {
  std::vector<std::string> strings;
  for (const json& item : Array(key, max_count)) {
    if (!item.is_string() || item.get_ref<const std::string&>().empty()) {
      FailType(key, item, "non-empty strings");
      return {};
    }
    strings.push_back(item.get<std::string>());
  }
  return strings;
}

std::vector<std::string> ObjectReader::UniqueStrings(const std::string& key, std::size_t max_count,
                                                     std::size_t max_bytes) {
  std::vector<std::string> strings = Strings(key, max_count);
  std::set<std::string> seen;
  for (const std::string& one : strings) {
    if (one.size() > max_bytes) {
      Fail(key, absl::StrCat("expected at most ", max_bytes, " bytes, got a name of ", one.size()));
    }
    if (!seen.insert(one).second) Fail(key, absl::StrCat(Quoted(one), " is repeated"));
  }
  return strings;
}

const json& ObjectReader::Array(const std::string& key, std::size_t max_count) {
  static const json* const kEmpty = new json(json::array());
  const json* value = Get(key);
  if (value == nullptr) return *kEmpty;
  if (value->is_array() && value->size() <= max_count) return *value;
  FailType(key, *value, absl::StrCat("an array of at most ", max_count, " values"));
  return *kEmpty;
}

const json& ObjectReader::Object(const std::string& key) {
  static const json* const kEmpty = new json(json::object());
  const json* value = Get(key);
  if (value == nullptr) return *kEmpty;
  if (value->is_object()) return *value;
  FailType(key, *value, "an object");
  return *kEmpty;
}

absl::Status ObjectReader::Finish() {
  if (!status_.ok() || !object_.is_object()) return status_;
  for (const auto& [key, value] : object_.items()) {
    if (asked_.count(key) == 0) {
      // Quoted, because a hostile key must not write control bytes into a log.
      Update(absl::InvalidArgumentError(
          absl::StrCat(path_.empty() ? "" : path_ + ": ", "unknown field ", Quoted(key))));
    }
  }
  return status_;
}

}  // namespace duet::base
