#include "server/config/print_config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/text_format.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "duet/v1/server_config.pb.h"

namespace duet::server::config {
namespace {

using google::protobuf::FieldDescriptor;

// Prints one line after the other.
class Printer {
 public:
  Printer(const v1::ServerConfig& config, const SettingSources& sources)
      : config_(config), sources_(sources) {
    printer_.SetSingleLineMode(true);
  }

  // `index` is -1 of a field that is not repeated.
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

}  // namespace

std::string PrintConfig(const ServerOptions& options, const SettingSources& sources) {
  const v1::ServerConfig config = ToConfig(options);
  const google::protobuf::Reflection& reflection = *config.GetReflection();
  Printer printer(config, sources);
  for (int i = 0; i < config.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *config.GetDescriptor()->field(i);
    const int count = field.is_repeated() ? reflection.FieldSize(config, &field) : 0;
    if (!field.is_repeated() && reflection.HasField(config, &field)) {
      printer.Print(field, -1);
    } else if (count == 0) {
      printer.PrintAbsent(field);
    }
    for (int element = 0; element < count; ++element) printer.Print(field, element);
  }
  return printer.Take();
}

}  // namespace duet::server::config
