#include "server/config/setting.h"

#include <cstddef>
#include <cstdint>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::server::config {
namespace {

using Field = google::protobuf::FieldDescriptor;

absl::Status Unexpected(absl::string_view expected, absl::string_view got) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(got)));
}

absl::Status AddVersionLabel(const std::string& text, v1::ServerConfig* config) {
  const std::vector<std::string> model = absl::StrSplit(text, absl::MaxSplits(':', 1));
  const std::vector<std::string> label = absl::StrSplit(model.back(), absl::MaxSplits('=', 1));
  uint32_t version = 0;
  if (model.size() != 2 || label.size() != 2 || !absl::SimpleAtoi(label[1], &version)) {
    return Unexpected("model:label=version, such as duet:stable=3", text);
  }
  v1::VersionLabel& added = *config->add_version_labels();
  added.set_model(model[0]);
  added.set_label(label[0]);
  added.set_version(version);
  return absl::OkStatus();
}

bool ParseSwitch(const std::string& text, bool* value) {
  *value = absl::EqualsIgnoreCase(text, "on");
  return *value || absl::EqualsIgnoreCase(text, "off") || absl::SimpleAtob(text, value);
}

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

std::string Setting::variable() const {
  return absl::StrCat(kVariablePrefix,
                      absl::AsciiStrToUpper(absl::StrReplaceAll(flag(), {{"-", "_"}})));
}

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

absl::Status Setting::Set(const std::string& text, v1::ServerConfig* config) const {
  const google::protobuf::Reflection& reflection = *config->GetReflection();
  constexpr char kWhole[] = "a whole number of 0 or more";
  std::uint32_t small = 0;
  std::uint64_t large = 0;
  double number = 0;
  bool on = false;
  switch (field_->cpp_type()) {
    case Field::CPPTYPE_UINT32:
      if (!absl::SimpleAtoi(text, &small)) return Unexpected(kWhole, text);
      reflection.SetUInt32(config, field_, small);
      break;
    case Field::CPPTYPE_UINT64:
      if (!absl::SimpleAtoi(text, &large)) return Unexpected(kWhole, text);
      reflection.SetUInt64(config, field_, large);
      break;
    case Field::CPPTYPE_DOUBLE:
      if (!absl::SimpleAtod(text, &number)) return Unexpected("a number", text);
      reflection.SetDouble(config, field_, number);
      break;
    case Field::CPPTYPE_BOOL:
      if (!ParseSwitch(text, &on)) return Unexpected("true or false", text);
      reflection.SetBool(config, field_, on);
      break;
    case Field::CPPTYPE_ENUM:
      return SetChoice(text, config);
    case Field::CPPTYPE_MESSAGE:
      return AddVersionLabel(text, config);  // the only one
    default:
      reflection.SetString(config, field_, text);
  }
  return absl::OkStatus();
}

absl::Status Setting::SetChoice(const std::string& text, v1::ServerConfig* config) const {
  std::vector<std::string> expected;
  for (const Choice& choice : ChoicesOf(*field_->enum_type())) {
    if (choice.flag_value == text) {
      config->GetReflection()->SetEnumValue(config, field_, choice.number);
      return absl::OkStatus();
    }
    expected.push_back(choice.flag_value);
  }
  return Unexpected(OneOf(expected), text);
}

void Setting::SetDefault(v1::ServerConfig* config) const {
  const std::string& value = options().default_value();
  if (!value.empty()) Set(value, config).IgnoreError();  // tests read every default
}

std::vector<Setting> AllSettings() {
  const google::protobuf::Descriptor& schema = *v1::ServerConfig::descriptor();
  std::vector<Setting> settings;
  for (int i = 0; i < schema.field_count(); ++i) settings.emplace_back(schema.field(i));
  return settings;
}

}  // namespace duet::server::config
