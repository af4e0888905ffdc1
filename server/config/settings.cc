#include "server/config/settings.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"
#include "server/common/listen_address.h"

namespace duet::server::config {

namespace {

using Field = google::protobuf::FieldDescriptor;

absl::Status Unexpected(absl::string_view expected, absl::string_view got) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(got)));
}

// "a, b or c", for messages.
std::string OneOf(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    absl::StrAppend(&text, i == 0 ? "" : i + 1 < names.size() ? ", " : " or ", names[i]);
  }
  return text;
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

namespace {

// Collects every mistake of a configuration, one line each:
// "field: expected ..., got ... (source, if known); hint".
class Mistakes {
 public:
  // `sources` outlives this object.
  explicit Mistakes(const SettingSources& sources) : sources_(sources) {}

  // `got` may quote a user's text as it is.
  void Add(absl::string_view field, absl::string_view expected, absl::string_view got,
           absl::string_view hint = "") {
    Add(absl::StrCat(field, ": expected ", expected, ", got ", got), hint);
  }
  // `message` begins with the field and a colon; it may quote a user's text as it is.
  void Add(const std::string& message, absl::string_view hint = "") {
    constexpr std::size_t kMaxLineBytes = 1000;
    const auto source = sources_.find(message.substr(0, message.find(':')));
    std::string line = base::Printable(message, kMaxLineBytes);
    if (source != sources_.end()) absl::StrAppend(&line, " (", source->second, ")");
    if (!hint.empty()) absl::StrAppend(&line, "; ", hint);
    lines_.push_back(std::move(line));
  }

  std::vector<std::string> Take() { return std::move(lines_); }

 private:
  const SettingSources& sources_;
  std::vector<std::string> lines_;
};

using common::AddressOf;
using common::ListenAddress;
using v1::ServerConfig;

std::string TextOf(double value) { return base::NumberText(value); }
template <typename Whole>
std::string TextOf(Whole value) {
  return absl::StrCat(value);
}

// Returns `value`, or `min` after a mistake. The setting's range has the maximum.
template <typename Number>
Number CheckRange(const Setting& setting, Number value, Number min, Mistakes& mistakes) {
  const v1::SettingRange& range = setting.options().range();
  const Number max =
      range.has_max() ? static_cast<Number>(range.max()) : std::numeric_limits<Number>::max();
  // Written so that NaN is out of range.
  if (value >= min && value <= max) return value;
  if (range.or_zero() && value == 0) return value;
  mistakes.Add(setting.name(), absl::StrCat(range.or_zero() ? "0, or " : "", min, " to ", max),
               TextOf(value));
  return min;
}

template <typename Number>
Number CheckRange(const Setting& setting, Number value, Mistakes& mistakes) {
  return CheckRange(setting, value, static_cast<Number>(setting.options().range().min()), mistakes);
}

// Restores the default after a mistake.
void CheckChoice(const Setting& setting, ServerConfig* values, Mistakes& mistakes) {
  const google::protobuf::Reflection& reflection = *values->GetReflection();
  const int number = reflection.GetEnumValue(*values, &setting.field());
  std::vector<std::string> names;
  for (const Choice& choice : ChoicesOf(*setting.field().enum_type())) {
    if (choice.number == number) return;
    names.push_back(choice.name);
  }
  mistakes.Add(setting.name(), OneOf(names), absl::StrCat(number));
  setting.SetDefault(values);
}

// Checks a field that is set against its type's choices or its range. A range that depends on other
// settings is checked with those.
void CheckField(const Setting& setting, ServerConfig* values, Mistakes& mistakes) {
  const google::protobuf::Reflection& reflection = *values->GetReflection();
  const Setting::Field* field = &setting.field();
  if (field->cpp_type() == Setting::Field::CPPTYPE_ENUM) {
    CheckChoice(setting, values, mistakes);
    return;
  }
  if (!setting.options().has_range() || !setting.options().range().min_text().empty()) return;
  switch (field->cpp_type()) {
    case Setting::Field::CPPTYPE_UINT32:
      reflection.SetUInt32(values, field,
                           CheckRange(setting, reflection.GetUInt32(*values, field), mistakes));
      return;
    case Setting::Field::CPPTYPE_UINT64:
      reflection.SetUInt64(values, field,
                           CheckRange(setting, reflection.GetUInt64(*values, field), mistakes));
      return;
    case Setting::Field::CPPTYPE_DOUBLE:
      reflection.SetDouble(values, field,
                           CheckRange(setting, reflection.GetDouble(*values, field), mistakes));
      return;
    default:
      return;
  }
}

bool IsSet(const Setting& setting, const ServerConfig& values) {
  return !setting.field().is_repeated() &&
         values.GetReflection()->HasField(values, &setting.field());
}

void SetDefaults(ServerConfig* values) {
  for (const Setting& setting : AllSettings()) {
    if (!IsSet(setting, *values)) setting.SetDefault(values);
  }
}

// Checks each field by itself.
void CheckFields(ServerConfig* values, Mistakes& mistakes) {
  for (const Setting& setting : AllSettings()) {
    if (IsSet(setting, *values)) CheckField(setting, values, mistakes);
  }
}

// The normal form of an address; "off" after a mistake.
std::string ReadAddress(absl::string_view field, const std::string& text, Mistakes& mistakes) {
  const absl::StatusOr<ListenAddress> address = common::ParseListenAddress(text);
  if (address.ok()) return ToString(*address);
  mistakes.Add(absl::StrCat(field, ": ", address.status().message()));
  return "off";
}

std::string ReadAddressOrOff(absl::string_view field, const std::string& text, Mistakes& mistakes) {
  return text.empty() || text == "off" ? "off" : ReadAddress(field, text, mistakes);
}

// Each listener needs a port of its own.
void ReadListeners(ServerConfig* values, Mistakes& mistakes) {
  values->set_listen(ReadAddress("listen", values->listen(), mistakes));
  values->set_metrics_listen(
      ReadAddressOrOff("metrics_listen", values->metrics_listen(), mistakes));
  values->set_admin_listen(ReadAddressOrOff("admin_listen", values->admin_listen(), mistakes));
  const std::vector<std::pair<absl::string_view, std::optional<ListenAddress>>> listeners = {
      {"listen", AddressOf(values->listen())},
      {"metrics_listen", AddressOf(values->metrics_listen())},
      {"admin_listen", AddressOf(values->admin_listen())}};
  for (std::size_t i = 0; i < listeners.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& [field, address] = listeners[i];
      const auto& [other_field, other] = listeners[j];
      if (!address.has_value() || !other.has_value() || !Clash(*address, *other)) continue;
      mistakes.Add(field, absl::StrCat("another port than ", other_field), ToString(*address),
                   absl::StrCat(other_field, " is ", ToString(*other),
                                "; port 0 is any free one, \"off\" none"));
    }
  }
}

// More workers than this for each core would only take turns; hundreds of them take a machine a
// minute to start. Small machines may exceed it for experiments.
constexpr int kWorkersPerCore = 4;
constexpr int kWorkersAnywhere = 32;

// An evaluation has one thread.
void ReadWorkers(const ServerConfig& given, int cores, ServerConfig* values, Mistakes& mistakes) {
  if (!given.has_workers()) values->set_workers(static_cast<uint32_t>(std::max(1, cores)));
  const auto most = static_cast<uint32_t>(std::max(kWorkersAnywhere, kWorkersPerCore * cores));
  if (values->workers() <= most) return;
  mistakes.Add("workers", absl::StrCat("1 to ", most, " on ", cores, " cores"),
               absl::StrCat(values->workers()));
}

// Runs after ReadWorkers: workers take memory.
void ReadMemory(const ServerConfig& given, std::uint64_t memory_bytes, ServerConfig* values,
                Mistakes& mistakes) {
  if (!given.has_memory_limit_bytes()) values->set_memory_limit_bytes(memory_bytes);
  FitCallsToMemory(given, values);
  if (given.has_max_transport_bytes()) {
    values->set_max_transport_bytes(CheckRange(Setting(ServerConfig::kMaxTransportBytesFieldNumber),
                                               given.max_transport_bytes(),
                                               2 * values->max_request_bytes(), mistakes));
  }
  if (given.has_max_held_bytes()) {
    values->set_max_held_bytes(CheckRange(Setting(ServerConfig::kMaxHeldBytesFieldNumber),
                                          given.max_held_bytes(), values->max_request_bytes(),
                                          mistakes));
  }
  FitBytesToMemory(given, values);
  if (!given.has_max_slow_requests()) {
    const uint64_t requests = values->max_transport_bytes() / (2 * values->max_request_bytes());
    values->set_max_slow_requests(static_cast<uint32_t>(std::clamp<uint64_t>(requests, 1, 100000)));
  }
}

// Whether metadata may hold text under this key.
bool IsMetadataKey(absl::string_view key) {
  return !absl::EndsWith(key, "-bin") && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '-' || c == '_' || c == '.';
  });
}

void CheckNames(const ServerConfig& values, Mistakes& mistakes) {
  if (!values.client_key().empty() && !IsMetadataKey(values.client_key())) {
    mistakes.Add("client_key", "lower-case letters, digits, '-', '_' and '.', not ending in -bin",
                 absl::StrCat("\"", values.client_key(), "\""));
  }
}

void CheckSecurity(const ServerConfig& values, Mistakes& mistakes) {
  if (values.tls_certificate_file().empty() != values.tls_key_file().empty()) {
    const bool no_key = values.tls_key_file().empty();
    mistakes.Add(no_key ? "tls_key_file" : "tls_certificate_file",
                 absl::StrCat("a file beside ", no_key ? "tls_certificate_file" : "tls_key_file"),
                 "none", "encryption needs both, plain text neither");
  }
  if (!values.tls_client_ca_file().empty() && values.tls_certificate_file().empty()) {
    mistakes.Add("tls_client_ca_file", "tls_certificate_file and tls_key_file beside it", "neither",
                 "only an encrypted connection can request client certificates");
  }
}

void CheckLabels(const ServerConfig& values, Mistakes& mistakes) {
  for (int i = 0; i < values.version_labels_size(); ++i) {
    const v1::VersionLabel& label = values.version_labels(i);
    if (!label.model().empty() && !label.label().empty() && label.version() != 0) continue;
    mistakes.Add(absl::StrCat("version_labels[", i, "]"),
                 "a model, a label and a version of 1 or more",
                 absl::StrCat("model \"", label.model(), "\", label \"", label.label(),
                              "\", version ", label.version()));
  }
}

}  // namespace

Settings ReadSettings(const ServerConfig& given, int cores, const SettingSources& sources,
                      std::uint64_t memory_bytes) {
  Mistakes mistakes(sources);
  ServerConfig values = given;
  SetDefaults(&values);
  ReadListeners(&values, mistakes);
  CheckFields(&values, mistakes);
  ReadWorkers(given, cores, &values, mistakes);
  ReadMemory(given, memory_bytes, &values, mistakes);
  CheckNames(values, mistakes);
  CheckSecurity(values, mistakes);
  CheckLabels(values, mistakes);
  return {std::move(values), mistakes.Take()};
}

}  // namespace duet::server::config
