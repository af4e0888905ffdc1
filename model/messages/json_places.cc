#include "model/messages/json_places.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/match.h"

namespace duet::messages {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 100;

// Converts offsets in a text to places.
class Lines {
 public:
  explicit Lines(absl::string_view text) : text_(text) {}
  Place At(std::size_t offset) const {
    const absl::string_view before = text_.substr(0, std::min(offset, text_.size()));
    const std::size_t line_end = before.rfind('\n');
    const std::size_t line_begin = line_end == absl::string_view::npos ? 0 : line_end + 1;
    return {1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
            1 + static_cast<int>(before.size() - line_begin)};
  }
  // The place of the string that ends before `end`. Within a string, quotes follow a backslash.
  Place OfString(std::size_t end) const {
    std::size_t begin = end - 1;
    do {
      begin = text_.rfind('"', begin - 1);
    } while (IsEscaped(begin));
    return At(begin);
  }

 private:
  bool IsEscaped(std::size_t offset) const {
    std::size_t backslashes = 0;
    while (backslashes < offset && text_[offset - 1 - backslashes] == '\\') ++backslashes;
    return backslashes % 2 == 1;
  }

  const absl::string_view text_;
};

// Iterates over a text's bytes and records how many the parser has consumed, because its events do
// not report their positions.
class Cursor {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Cursor(const char* at, const char** latest) : at_(at), latest_(latest) {}
  reference operator*() const { return *at_; }
  Cursor& operator++() {
    *latest_ = ++at_;
    return *this;
  }
  Cursor operator++(int) {
    const Cursor before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const Cursor& a, const Cursor& b) { return a.at_ == b.at_; }
  friend bool operator!=(const Cursor& a, const Cursor& b) { return a.at_ != b.at_; }

 private:
  const char* at_;
  const char** latest_;
};

// The parser's message without its own name and place, which it counts differently.
std::string Reason(const json::exception& exception) {
  const std::string text = exception.what();
  constexpr absl::string_view kAfter = ": ";
  const std::size_t place = text.find(", column ");
  const std::size_t colon = text.find(kAfter.data(), place == std::string::npos ? 0 : place);
  return colon == std::string::npos ? text : text.substr(colon + kAfter.size());
}

class PlaceFinder : public nlohmann::json_sax<json> {
 public:
  PlaceFinder(absl::string_view text, const char* const* latest)
      : begin_(text.data()), latest_(latest), lines_(text) {}

  JsonPlaces Take() { return std::move(places_); }

  bool null() override { return Word(); }
  bool boolean(bool) override { return Word(); }
  bool number_integer(number_integer_t) override { return Word(); }
  bool number_unsigned(number_unsigned_t) override { return Word(); }
  bool number_float(number_float_t, const string_t&) override { return Word(); }
  bool string(string_t&) override { return Word(); }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return Open(/*array=*/false); }
  bool start_array(std::size_t) override { return Open(/*array=*/true); }
  bool end_object() override { return Close(); }
  bool end_array() override { return Close(); }

  bool key(string_t& name) override {
    if (depth_ == 1) places_.keys.push_back({name, lines_.OfString(Offset()), {}});
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const json::exception& exception) override {
    places_.error = Reason(exception);
    places_.error_place = lines_.At(Offset() == 0 ? 0 : Offset() - 1);
    return false;
  }

 private:
  // The number of bytes consumed. At the event of a string or bracket, this includes its last byte.
  std::size_t Offset() const { return static_cast<std::size_t>(*latest_ - begin_); }

  bool Word() {
    if (InArrayOfKey()) places_.keys.back().elements.push_back(places_.keys.back().place);
    return true;
  }
  bool Open(bool array) {
    const Place place = lines_.At(Offset() - 1);
    if (InArrayOfKey()) places_.keys.back().elements.push_back(place);
    if (depth_ == 1) key_has_array_ = array;
    if (++depth_ <= kMaxDepth) return true;
    places_.error = "nested deeper than a hundred levels";
    places_.error_place = place;
    return false;
  }
  bool Close() {
    --depth_;
    return true;
  }
  bool InArrayOfKey() const { return depth_ == 2 && key_has_array_ && !places_.keys.empty(); }

  const char* const begin_;
  const char* const* const latest_;
  const Lines lines_;
  JsonPlaces places_;
  int depth_ = 0;
  bool key_has_array_ = false;
};

}  // namespace

JsonPlaces FindJsonPlaces(absl::string_view text) {
  const char* latest = text.data();
  PlaceFinder finder(text, &latest);
  json::sax_parse(Cursor(text.data(), &latest), Cursor(text.data() + text.size(), &latest),
                  &finder);
  return finder.Take();
}

}  // namespace duet::messages
