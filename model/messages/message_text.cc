#include "model/messages/message_text.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "model/base/nearest.h"
#include "model/base/printable.h"
#include "model/base/text.h"

namespace duet::messages {
namespace {

// The places of the fields of a JSON text's root object.
struct JsonPlaces {
  struct Element {
    std::string key;
    Place place;  // of the key
    // If the value is an array, the place of each item: where an object or array begins, and the
    // key's place for every other item.
    std::vector<Place> elements;
  };
  std::vector<Element> keys;  // in the order of the text, repeated keys included
  // The first syntax error and its place; empty if there is none.
  std::string error;
  Place error_place;
};

// Scans a text without building a document. More than a hundred levels of nesting are an error.
JsonPlaces FindJsonPlaces(absl::string_view text);

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

JsonPlaces FindJsonPlaces(absl::string_view text) {
  const char* latest = text.data();
  PlaceFinder finder(text, &latest);
  json::sax_parse(Cursor(text.data(), &latest), Cursor(text.data() + text.size(), &latest),
                  &finder);
  return finder.Take();
}

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using nlohmann::json;

constexpr std::size_t kLongestProblem = 500;

// The errors of a text and their places.
class Problems {
 public:
  // Escapes the problem, because the parsers quote the text verbatim.
  void Add(Place place, absl::string_view problem) {
    problems_.emplace_back(place, base::Printable(problem, kLongestProblem));
  }
  bool empty() const { return problems_.empty(); }
  absl::Status ToStatus() {
    if (problems_.empty()) return absl::OkStatus();
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return absl::InvalidArgumentError(
        absl::StrJoin(problems_, "\n", [](std::string* out, const auto& problem) {
          const auto& [place, what] = problem;
          absl::StrAppend(out, "line ", place.line, ":", place.column, ": ", what);
        }));
  }

 private:
  std::vector<std::pair<Place, std::string>> problems_;
};

std::string ElementName(const FieldDescriptor& field, int index) {
  return absl::StrCat(field.name(), "[", index, "]");
}

// The parser counts from 0; -1 means the whole file.
Place FromZero(int line, int column) { return {line + 1, column + 1}; }

// The parser reports unknown fields as warnings and continues after them.
class ProblemCollector final : public google::protobuf::io::ErrorCollector {
 public:
  explicit ProblemCollector(Problems* problems) : problems_(problems) {}
  void AddError(int line, google::protobuf::io::ColumnNumber column,
                const std::string& message) override {
    problems_->Add(FromZero(line, column), message);
  }
  void AddWarning(int line, google::protobuf::io::ColumnNumber column,
                  const std::string& message) override {
    problems_->Add(FromZero(line, column), message);
  }

 private:
  Problems* const problems_;
};

// The places at which the text format's parser found a message's fields.
FieldPlaces ToPlaces(const google::protobuf::TextFormat::ParseInfoTree& tree,
                     const Message& message) {
  FieldPlaces places;
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  const auto add = [&](const FieldDescriptor& field, int index, const std::string& name) {
    const auto location = tree.GetLocation(&field, index);
    places[name] = FromZero(location.line, location.column);
  };
  for (const FieldDescriptor* field : fields) {
    if (!field->is_repeated()) add(*field, -1, field->name());
    for (int i = 0; field->is_repeated() && i < message.GetReflection()->FieldSize(message, field);
         ++i) {
      add(*field, i, ElementName(*field, i));
    }
  }
  return places;
}

void ParseTextFormat(absl::string_view text, Message* message, FieldPlaces* places,
                     Problems* problems) {
  ProblemCollector collector(problems);
  google::protobuf::TextFormat::ParseInfoTree tree;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&collector);
  parser.WriteLocationsTo(&tree);
  parser.AllowUnknownField(true);
  parser.ParseFromString(std::string(text), message);
  *places = ToPlaces(tree, *message);
}

// Reads a JSON object field by field, so that each error has its place.
class JsonFields {
 public:
  JsonFields(Message* message, FieldPlaces* places, Problems* problems)
      : message_(*message),
        descriptor_(*message->GetDescriptor()),
        places_(*places),
        problems_(*problems) {}

  // Requires that `object` has the keys of `found`, and the last value of a repeated key.
  void Read(const json& object, const JsonPlaces& found) {
    std::set<const FieldDescriptor*> seen;
    for (const JsonPlaces::Element& element : found.keys) {
      const FieldDescriptor* field = Find(element.key);
      if (field == nullptr) {
        problems_.Add(element.place, absl::StrCat("there is no field ", base::Quoted(element.key),
                                                  base::DidYouMean(element.key, Names())));
      } else if (!seen.insert(field).second) {
        problems_.Add(element.place, absl::StrCat(field->name(), ": is repeated"));
      } else {
        ReadField(*field, object.at(element.key), LastOf(element.key, found));
      }
    }
  }

 private:
  // The last occurrence of a key: the object has its value.
  static const JsonPlaces::Element& LastOf(const std::string& key, const JsonPlaces& found) {
    return *std::find_if(found.keys.rbegin(), found.keys.rend(),
                         [&key](const JsonPlaces::Element& element) { return element.key == key; });
  }

  // By its name in the schema, or by protobuf's name for it in JSON.
  const FieldDescriptor* Find(const std::string& key) const {
    for (int i = 0; i < descriptor_.field_count(); ++i) {
      const FieldDescriptor* field = descriptor_.field(i);
      if (field->name() == key || field->json_name() == key) return field;
    }
    return nullptr;
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (int i = 0; i < descriptor_.field_count(); ++i) {
      names.push_back(descriptor_.field(i)->name());
    }
    return names;
  }

  void ReadField(const FieldDescriptor& field, const json& value,
                 const JsonPlaces::Element& element) {
    if (!field.is_repeated() || !value.is_array()) {
      places_[field.name()] = element.place;
      ReadValue(field, value, element.place, 0);
      return;
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      const int index = static_cast<int>(i);
      places_[ElementName(field, index)] = element.elements[i];
      ReadValue(field, json::array({value[i]}), element.elements[i], index);
    }
  }

  void ReadValue(const FieldDescriptor& field, const json& value, Place place, int index) {
    const std::unique_ptr<Message> part(message_.New());
    const auto status = google::protobuf::util::JsonStringToMessage(
        json::object({{field.name(), value}}).dump(), part.get());
    if (status.ok()) {
      message_.MergeFrom(*part);
      return;
    }
    // The parser counts the elements of `part`, which has one.
    problems_.Add(place, absl::StrReplaceAll(std::string(status.message()),
                                             {{ElementName(field, 0), ElementName(field, index)}}));
  }

  Message& message_;
  const Descriptor& descriptor_;
  FieldPlaces& places_;
  Problems& problems_;
};

void ParseJson(absl::string_view text, Message* message, FieldPlaces* places, Problems* problems) {
  const auto whole = google::protobuf::util::JsonStringToMessage(std::string(text), message);
  const JsonPlaces found = FindJsonPlaces(text);
  // Protobuf's parser accepts slightly more than JSON.
  if (whole.ok() && !found.error.empty()) return;
  if (!found.error.empty()) {
    problems->Add(found.error_place, found.error);
    return;
  }
  const json object = json::parse(text.begin(), text.end(), nullptr, /*allow_exceptions=*/false);
  if (object.is_object()) {
    const std::unique_ptr<Message> read(message->New());
    JsonFields(read.get(), places, problems).Read(object, found);
    // The parts are read one by one. Only reading the whole finds errors between fields, such as
    // two members of a oneof.
    if (!whole.ok()) message->CopyFrom(*read);
  }
  if (!whole.ok() && problems->empty()) problems->Add({}, std::string(whole.message()));
}

}  // namespace

absl::Status ParseMessage(absl::string_view text, MessageSyntax syntax, Message* message,
                          FieldPlaces* places) {
  message->Clear();
  Problems problems;
  FieldPlaces found;
  if (syntax == MessageSyntax::kJson) {
    ParseJson(text, message, &found, &problems);
  } else {
    ParseTextFormat(text, message, &found, &problems);
  }
  if (places != nullptr) *places = std::move(found);
  return problems.ToStatus();
}

}  // namespace duet::messages
