#include "server/config/setting.h"

#include <google/protobuf/text_format.h>

#include <cstddef>
#include <cstdint>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "server/config/environment.h"

namespace duet::server::config {
namespace {

using Field = google::protobuf::FieldDescriptor;

// "1 to 100000" with the numbers of the field's type.
template <typename Number>
std::string RangeText(const v1::SettingRange& range) {
  const Number max =
      range.has_max() ? static_cast<Number>(range.max()) : std::numeric_limits<Number>::max();
  const std::string min =
      range.min_text().empty() ? absl::StrCat(static_cast<Number>(range.min())) : range.min_text();
  return absl::StrCat(range.or_zero() ? "0, or " : "", min, " to ", max);
}

}  // namespace

std::vector<Choice> ChoicesOf(const google::protobuf::EnumDescriptor& type) {
  absl::string_view prefix = type.FindValueByNumber(0)->name();
  absl::ConsumeSuffix(&prefix, "UNSPECIFIED");
  std::vector<Choice> choices;
  for (int i = 0; i < type.value_count(); ++i) {
    const google::protobuf::EnumValueDescriptor& value = *type.value(i);
    if (value.number() == 0) continue;
    choices.push_back({absl::AsciiStrToLower(absl::StripPrefix(value.name(), prefix)), value.name(),
                       value.number()});
  }
  return choices;
}

std::string OneOf(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    absl::StrAppend(&text, i == 0 ? "" : i + 1 < names.size() ? ", " : " or ", names[i]);
  }
  return text;
}

std::string Setting::flag() const {
  if (!options().flag().empty()) return options().flag();
  return absl::StrReplaceAll(name(), {{"_", "-"}});
}

std::string Setting::variable() const { return VariableOfFlag(flag()); }

std::string Setting::unit() const {
  if (field_->cpp_type() != Field::CPPTYPE_ENUM) return options().unit();
  return absl::StrJoin(
      ChoicesOf(*field_->enum_type()), "|",
      [](std::string* text, const Choice& choice) { text->append(choice.flag_value); });
}

std::string Setting::default_text() const {
  const std::string& value = options().default_value();
  if (value.empty()) return options().default_text();
  if (field_->cpp_type() != Field::CPPTYPE_BOOL) return value;
  return value == "true" ? "on" : "off";
}

std::string Setting::range_text() const {
  if (!options().has_range()) return "";
  switch (field_->cpp_type()) {
    case Field::CPPTYPE_UINT32:
      return RangeText<uint32_t>(options().range());
    case Field::CPPTYPE_UINT64:
      return RangeText<uint64_t>(options().range());
    default:
      return RangeText<double>(options().range());
  }
}

std::string Setting::help() const {
  if (default_text().empty()) return options().help();
  const bool is_value = !options().default_value().empty();
  return absl::StrCat(options().help(), " (default", is_value ? " " : ": ", default_text(), ")");
}

void Setting::SetDefault(v1::ServerConfig* config) const {
  const std::string& value = options().default_value();
  if (value.empty()) return;
  const google::protobuf::Reflection& reflection = *config->GetReflection();
  switch (field_->cpp_type()) {
    case Field::CPPTYPE_STRING:
      reflection.SetString(config, field_, value);
      return;
    case Field::CPPTYPE_ENUM:
      for (const Choice& choice : ChoicesOf(*field_->enum_type())) {
        if (choice.flag_value == value) reflection.SetEnumValue(config, field_, choice.number);
      }
      return;
    default:
      google::protobuf::TextFormat::ParseFieldValueFromString(value, field_, config);
  }
}

std::vector<Setting> AllSettings() {
  const google::protobuf::Descriptor& schema = *v1::ServerConfig::descriptor();
  std::vector<Setting> settings;
  for (int i = 0; i < schema.field_count(); ++i) settings.emplace_back(schema.field(i));
  return settings;
}

}  // namespace duet::server::config
