#include "model/base/json_events.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>

namespace duet::base {
namespace {

using nlohmann::json;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// A byte that stands for itself in a string: printable ASCII, no quote, no escape.
bool IsPlain(char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; }

class EventReader {
 public:
  EventReader(std::string_view text, nlohmann::json_sax<json>* events)
      : at_(text.data()), end_(at_ + text.size()), events_(*events) {}

  bool Read() {
    if (!ReadValue()) return false;
    while (!open_.empty()) {
      SkipSpace();
      if (Take(open_.back() == '[' ? ']' : '}')) {
        if (!Close()) return false;
        continue;
      }
      if (!is_empty_ && !Take(',')) return false;
      if (open_.back() == '{' && !ReadKey()) return false;
      if (!ReadValue()) return false;
    }
    SkipSpace();
    return at_ == end_;
  }

 private:
  // The next byte; at the end NUL, which no document has.
  char Peek() const { return at_ == end_ ? '\0' : *at_; }
  bool Take(char c) {
    if (Peek() != c) return false;
    ++at_;
    return true;
  }
  bool TakeWord(std::string_view word) {
    if (std::string_view(at_, Rest()).substr(0, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }
  std::size_t Rest() const { return static_cast<std::size_t>(end_ - at_); }
  void SkipSpace() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
  }

  // Opens an array or object, or reads any other value as a whole.
  bool ReadValue() {
    SkipSpace();
    is_empty_ = Peek() == '[' || Peek() == '{';
    switch (Peek()) {
      case '[':
      case '{':
        return Open();
      case '"':
        return ReadString() && events_.string(text_);
      case 't':
        return TakeWord("true") && events_.boolean(true);
      case 'f':
        return TakeWord("false") && events_.boolean(false);
      case 'n':
        return TakeWord("null") && events_.null();
      default:
        return ReadNumber();
    }
  }

  bool Open() {
    open_.push_back(*at_++);
    return open_.back() == '[' ? events_.start_array(kUnknownSize)
                               : events_.start_object(kUnknownSize);
  }

  bool Close() {
    const char kind = open_.back();
    open_.pop_back();
    is_empty_ = false;
    return kind == '[' ? events_.end_array() : events_.end_object();
  }

  bool ReadKey() {
    SkipSpace();
    if (Peek() != '"' || !ReadString() || !events_.key(text_)) return false;
    SkipSpace();
    return Take(':');
  }

  // Reads a string into text_.
  bool ReadString() {
    const char* const begin = at_++;
    while (at_ != end_ && IsPlain(*at_)) ++at_;
    if (Peek() == '"') {
      text_.assign(begin + 1, at_++);
      return true;
    }
    return ReadAnyString(begin);
  }

  // Reads a string with escapes or UTF-8, which needs not be fast.
  bool ReadAnyString(const char* begin) {
    while (at_ != end_ && *at_ != '"') at_ += *at_ == '\\' && Rest() > 1 ? 2 : 1;
    if (!Take('"')) return false;
    json parsed = json::parse(begin, at_, nullptr, /*allow_exceptions=*/false);
    if (!parsed.is_string()) return false;
    text_ = std::move(parsed.get_ref<std::string&>());
    return true;
  }

  // Skips one or more digits.
  bool SkipDigits() {
    const char* const begin = at_;
    while (at_ != end_ && IsDigit(*at_)) ++at_;
    return at_ != begin;
  }

  bool ReadNumber() {
    const char* const begin = at_;
    const bool negative = Take('-');
    if (!Take('0') && !SkipDigits()) return false;
    bool whole = true;
    if (Take('.')) {
      whole = false;
      if (!SkipDigits()) return false;
    }
    if (Take('e') || Take('E')) {
      whole = false;
      if (!Take('+')) Take('-');
      if (!SkipDigits()) return false;
    }
    if (whole && !negative) return SendWhole<std::uint64_t>(begin);
    return whole ? SendWhole<std::int64_t>(begin) : SendFloat(begin);
  }

  // A whole number beyond the type is a float.
  template <typename Whole>
  bool SendWhole(const char* begin) {
    Whole value = 0;
    if (std::from_chars(begin, at_, value).ec != std::errc()) return SendFloat(begin);
    if constexpr (std::is_signed_v<Whole>) return events_.number_integer(value);
    return events_.number_unsigned(value);
  }

  bool SendFloat(const char* begin) {
    double value = 0;
    if (std::from_chars(begin, at_, value).ec != std::errc()) return false;
    static const std::string* const kNone = new std::string();
    return events_.number_float(value, *kNone);
  }

  static constexpr std::size_t kUnknownSize = std::numeric_limits<std::size_t>::max();

  const char* at_;
  const char* const end_;
  nlohmann::json_sax<json>& events_;
  std::string open_;       // '[' or '{' of each open array and object
  bool is_empty_ = false;  // the innermost one has no value so far
  std::string text_;       // of the last string or key
};

}  // namespace

bool ReadJsonEvents(std::string_view text, nlohmann::json_sax<json>* events) {
  return EventReader(text, events).Read();
}

}  // namespace duet::base
