#include "tests/base/json_event_comparison.h"

#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "model/base/json_events.h"

namespace duet::base::test {
namespace {

using nlohmann::json;

// Writes down every event, and numbers by their bits.
class EventLog final : public nlohmann::json_sax<json> {
 public:
  const std::string& text() const { return text_; }
  // A decimal that a double holds with less precision, or as 0.
  bool has_tiny_number() const { return has_tiny_number_; }

  bool null() override { return Add("null"); }
  bool boolean(bool value) override { return Add(value ? "true" : "false"); }
  bool number_integer(number_integer_t value) override { return Add(absl::StrCat("i", value)); }
  bool number_unsigned(number_unsigned_t value) override { return Add(absl::StrCat("u", value)); }
  bool number_float(number_float_t value, const string_t&) override {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    has_tiny_number_ |= std::abs(value) < DBL_MIN;
    return Add(absl::StrCat("f", absl::Hex(bits)));
  }
  bool string(string_t& value) override { return Add(absl::StrCat("s", value.size(), " ", value)); }
  bool binary(binary_t&) override { return Add("binary"); }
  bool key(string_t& name) override { return Add(absl::StrCat("k", name.size(), " ", name)); }
  bool start_object(std::size_t size) override { return Add(absl::StrCat("{", size)); }
  bool start_array(std::size_t size) override { return Add(absl::StrCat("[", size)); }
  bool end_object() override { return Add("}"); }
  bool end_array() override { return Add("]"); }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override {
    return false;
  }

 private:
  bool Add(std::string_view event) {
    text_.append(event).push_back('\n');
    return true;
  }

  std::string text_;
  bool has_tiny_number_ = false;
};

bool IsOutsideOfTheContract(std::string_view text, const EventLog& log) {
  return log.has_tiny_number() || text.substr(0, 3) == "\xEF\xBB\xBF" ||
         text.find('\0') != std::string_view::npos;
}

}  // namespace

std::string CompareJsonEvents(std::string_view text) {
  EventLog log, expected;
  const bool read = ReadJsonEvents(text, &log);
  const bool is_json = json::sax_parse(text.begin(), text.end(), &expected);
  if (read && !is_json) return "read a text that is not JSON";
  if (read && log.text() != expected.text()) {
    return absl::StrCat("events:\n", log.text(), "expected:\n", expected.text());
  }
  const bool may_reject = !is_json || IsOutsideOfTheContract(text, expected);
  return read || may_reject ? "" : "rejected JSON";
}

}  // namespace duet::base::test
