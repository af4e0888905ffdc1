#include "server/config/print_config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/text_format.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/config/setting.h"

namespace duet::server::config {
namespace {

using google::protobuf::FieldDescriptor;

class Printer {
 public:
  Printer(const v1::ServerConfig& config, const SettingSources& sources)
      : config_(config), sources_(sources) {
    printer_.SetSingleLineMode(true);
  }

  // `index` is -1 for a field that is not repeated.
  void Print(const FieldDescriptor& field, int index) {
    std::string value;
    printer_.PrintFieldValueToString(config_, &field, index, &value);
    const bool is_message = field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    const std::string name = index < 0 ? field.name() : absl::StrCat(field.name(), "[", index, "]");
    const auto source = sources_.find(name);
    absl::StrAppend(&text_, field.name(), is_message ? " { " : ": ", value, is_message ? "}" : "",
                    "  # ", source == sources_.end() ? "default" : source->second, "\n");
  }

  void PrintAbsent(const FieldDescriptor& field) {
    absl::StrAppend(&text_, "# ", field.name(), " is not set\n");
  }

  std::string Take() { return std::move(text_); }

 private:
  const v1::ServerConfig& config_;
  const SettingSources& sources_;
  google::protobuf::TextFormat::Printer printer_;
  std::string text_;
};

// An empty text counts as absent.
bool IsAbsent(const v1::ServerConfig& settings, const FieldDescriptor& field) {
  const google::protobuf::Reflection& reflection = *settings.GetReflection();
  if (field.is_repeated() || !reflection.HasField(settings, &field)) return true;
  return field.cpp_type() == FieldDescriptor::CPPTYPE_STRING &&
         reflection.GetString(settings, &field).empty();
}

}  // namespace

std::string PrintConfig(const v1::ServerConfig& settings, const SettingSources& sources) {
  const google::protobuf::Reflection& reflection = *settings.GetReflection();
  Printer printer(settings, sources);
  for (const Setting& setting : AllSettings()) {
    const FieldDescriptor& field = setting.field();
    const int count = field.is_repeated() ? reflection.FieldSize(settings, &field) : 0;
    for (int element = 0; element < count; ++element) printer.Print(field, element);
    if (count > 0) continue;
    if (IsAbsent(settings, field)) {
      printer.PrintAbsent(field);
    } else {
      printer.Print(field, -1);
    }
  }
  return printer.Take();
}

}  // namespace duet::server::config
