#include "model/messages/message_text.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"

namespace duet::messages {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::size_t kLongestProblem = 500;
constexpr int kMaxJsonDepth = 100;

// The errors of a text and their places.
class Problems {
 public:
  // Escapes the problem, because the parsers quote the text verbatim.
  void Add(Place place, absl::string_view problem) {
    problems_.emplace_back(place, base::Printable(problem, kLongestProblem));
  }
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

// Protobuf's parser alone accepts more than JSON, and the last of two equal keys.
absl::Status ParseJson(absl::string_view text, Message* message) {
  const absl::Status json = base::ParseHandwrittenJson(text, kMaxJsonDepth).status();
  if (!json.ok()) return json;
  const auto read = google::protobuf::util::JsonStringToMessage(
      std::string(base::SkipByteOrderMark(text)), message);
  if (read.ok()) return absl::OkStatus();
  return absl::InvalidArgumentError(base::Printable(std::string(read.message()), kLongestProblem));
}

}  // namespace

absl::Status ParseMessage(absl::string_view text, MessageSyntax syntax, Message* message,
                          FieldPlaces* places) {
  message->Clear();
  if (syntax == MessageSyntax::kJson) return ParseJson(text, message);
  Problems problems;
  FieldPlaces found;
  ParseTextFormat(text, message, &found, &problems);
  if (places != nullptr) *places = std::move(found);
  return problems.ToStatus();
}

}  // namespace duet::messages
