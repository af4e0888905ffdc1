#include "model/training/options.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/reflection.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/status_macros.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/checkpoint/json_fields.h"
#include "model/retargeting/anatomy.h"
#include "model/training/named_configs.inc"

namespace duet::training {
namespace {

using google::protobuf::Message;
using nlohmann::json;
using Field = google::protobuf::FieldDescriptor;

using Replacements = std::vector<std::pair<std::string, std::string>>;

constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kMostWords = 256;
constexpr int kMaxDepth = 4;

// Calls `visit(field)` for each setting of a message. Those that only another schedule has are left
// out.
template <typename Visit>
void ForEachSetting(const Message& message, const Visit& visit) {
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const google::protobuf::FieldOptions& options = type.field(i)->options();
    if (options.HasExtension(with_schedule)) {
      const auto& optimiser = static_cast<const CommonSettings::Optimiser&>(message);
      if (optimiser.schedule() != options.GetExtension(with_schedule)) continue;
    }
    visit(*type.field(i));
  }
}

// The name of an enum's value in configurations.
std::string WordOf(const google::protobuf::EnumValueDescriptor& value) {
  return absl::AsciiStrToLower(value.name());
}

int ReadWord(const google::protobuf::EnumDescriptor& type, const std::string& name,
             base::ObjectReader* reader) {
  const std::string word = reader->String(name, kMaxNameBytes);
  std::vector<std::string> words;
  for (int i = 0; i < type.value_count(); ++i) {
    words.push_back(WordOf(*type.value(i)));
    if (words.back() == word) return type.value(i)->number();
  }
  reader->Fail(name, absl::StrCat("expected one of ", absl::StrJoin(words, ", "), ", got ",
                                  base::Quoted(word)));
  return type.value(0)->number();
}

// Reads the settings that a message declares from the fields of the same names.
void ReadSettings(base::ObjectReader* reader, Message* message) {
  const google::protobuf::Reflection& to = *message->GetReflection();
  ForEachSetting(*message, [&](const Field& field) {
    const std::string& name = field.name();
    const google::protobuf::FieldOptions& options = field.options();
    const double least = options.GetExtension(at_least);
    const double most = options.HasExtension(at_most) ? options.GetExtension(at_most) : 1;
    if (field.has_default_value() && !reader->Has(name)) return;
    switch (field.cpp_type()) {
      case Field::CPPTYPE_MESSAGE: {
        // A section whose settings all have a default may be absent.
        const json section = reader->Has(name) ? reader->Object(name) : json::object();
        base::ObjectReader fields(section, reader->PathOf(name));
        ReadSettings(&fields, to.MutableMessage(message, &field));
        return reader->Update(fields.Finish());
      }
      case Field::CPPTYPE_STRING:
        if (!reader->Has(name)) return;
        for (const std::string& word : reader->Strings(name, kMostWords)) {
          to.AddString(message, &field, word);
        }
        return;
      case Field::CPPTYPE_ENUM:
        return to.SetEnumValue(message, &field, ReadWord(*field.enum_type(), name, reader));
      case Field::CPPTYPE_BOOL:
        return to.SetBool(message, &field, reader->Bool(name));
      case Field::CPPTYPE_UINT64:
        return to.SetUInt64(message, &field,
                            static_cast<uint64_t>(reader->Int(name, 0, INT64_MAX)));
      case Field::CPPTYPE_INT64:
        return to.SetInt64(
            message, &field,
            reader->Int(name, static_cast<int64_t>(least), static_cast<int64_t>(most)));
      default:
        return to.SetDouble(message, &field, reader->Number(name, least, most));
    }
  });
}

// Adds the values of all settings by dotted path, as the shortest texts that read back the same.
void AddTexts(const Message& message, const std::string& path,
              std::map<std::string, std::string>* texts) {
  const google::protobuf::Reflection& from = *message.GetReflection();
  ForEachSetting(message, [&](const Field& field) {
    const std::string at = path + field.name();
    switch (field.cpp_type()) {
      case Field::CPPTYPE_MESSAGE:
        return AddTexts(from.GetMessage(message, &field), at + ".", texts);
      case Field::CPPTYPE_STRING:
        (*texts)[at] = absl::StrJoin(from.GetRepeatedFieldRef<std::string>(message, &field), " ");
        return;
      case Field::CPPTYPE_ENUM:
        (*texts)[at] = WordOf(*from.GetEnum(message, &field));
        return;
      case Field::CPPTYPE_DOUBLE:
        (*texts)[at] =
            std::string(absl::StripSuffix(json(from.GetDouble(message, &field)).dump(), ".0"));
        return;
      default:
        google::protobuf::TextFormat::PrintFieldValueToString(message, &field, -1, &(*texts)[at]);
    }
  });
}

// The settings of the method that trains the architecture.
Message* MethodOf(const checkpoint::PaperArchitecture&, TrainingOptions* options) {
  return &options->paper;
}
Message* MethodOf(const checkpoint::FlowArchitecture&, TrainingOptions* options) {
  return &options->flow;
}
Message* MethodOf(TrainingOptions* options) {
  return std::visit([options](const auto& one) { return MethodOf(one, options); },
                    options->architecture);
}

absl::StatusOr<TrainingOptions> ReadOptions(const json& value) {
  base::ObjectReader root(value, "");
  TrainingOptions options;
  checkpoint::ReadSection(&root, "generator", [&options](base::ObjectReader* generator) {
    options.architecture =
        checkpoint::ReadArchitecture(generator->Has(checkpoint::kArchitectureKind), generator);
  });
  options.standardisation =
      checkpoint::ReadNamed(&root, "standardisation", checkpoint::kStandardisationNames);
  ReadSettings(&root, MethodOf(&options));
  ReadSettings(&root, &options.common);
  if (absl::Status status = root.Finish(); !status.ok()) return status;
  const CommonSettings::Start& start = options.common.start();
  if (start.root() + start.pose() <= 1) return options;
  return absl::InvalidArgumentError(absl::StrCat("start.pose: expected at most ", 1 - start.root(),
                                                 ", got ", start.pose(),
                                                 ": root and pose are shares of all clips"));
}

// A replacement's value: parsed as JSON if possible, else the text itself.
json ParseValue(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

absl::Status Replace(const std::string& path, const std::string& text, json* root) {
  json* at = root;
  for (const std::string& key : std::vector<std::string>(absl::StrSplit(path, '.'))) {
    // Of a section or a field that is absent from the file: the reader rejects unknown names.
    if (at->is_null()) *at = json::object();
    if (!at->is_object()) return absl::InvalidArgumentError(path + ": no such setting");
    at = &(*at)[key];
  }
  *at = ParseValue(text);
  return absl::OkStatus();
}

// Parses a base and the changes to it.
absl::StatusOr<TrainingOptions> ParseDerived(const json& value, const Replacements& replacements) {
  base::ObjectReader reader(value, "");
  const std::string name = reader.String("base", kMaxNameBytes);
  const NamedConfig* const base = FindConfig(name);
  if (reader.ok() && base == nullptr) {
    reader.Fail("base", absl::StrCat("expected a named configuration, got ", base::Quoted(name)));
  }
  const json& set = reader.Object("set");
  DUET_RETURN_IF_ERROR(reader.Finish());
  Replacements all;
  for (const auto& [path, setting] : set.items()) all.emplace_back(path, setting.dump());
  all.insert(all.end(), replacements.begin(), replacements.end());
  return ParseConfig(base->json, all);
}

// A mirror image is wrong if left and right joints are not exchanged.
absl::Status CheckMirror(const CommonSettings::Augmentation& augmentation,
                         const motion::Skeleton& skeleton) {
  if (augmentation.mirror() == 0) return absl::OkStatus();
  const std::vector<int> counterparts = retargeting::CounterpartJoints(skeleton.joint_names);
  for (size_t joint = 0; joint < counterparts.size(); ++joint) {
    if (counterparts[joint] != static_cast<int>(joint)) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("augmentation.mirror: ", augmentation.mirror(),
                   ", but no joint's name says left or right; expected names such as left_hand and "
                   "right_hand, or "
                   "augmentation.mirror=0"));
}

}  // namespace

const NamedConfig* FindConfig(std::string_view name) {
  for (const NamedConfig& config : NamedConfigs()) {
    if (config.name == name) return &config;
  }
  return nullptr;
}

absl::StatusOr<TrainingOptions> ParseConfig(std::string_view text,
                                            const Replacements& replacements) {
  DUET_TRY(json root, base::ParseStrictJson(text, kMaxDepth));
  if (root.contains("base")) return ParseDerived(root, replacements);
  for (const auto& [path, value] : replacements) {
    DUET_RETURN_IF_ERROR(Replace(path, value, &root));
  }
  return ReadOptions(root);
}

std::map<std::string, std::string> Describe(const TrainingOptions& options) {
  TrainingOptions described = options;
  std::map<std::string, std::string> texts = {
      {"standardisation",
       std::string(NameOf(checkpoint::kStandardisationNames, options.standardisation))}};
  AddTexts(described.common, "", &texts);
  AddTexts(*MethodOf(&described), "", &texts);
  return texts;
}

absl::Status CheckAgainst(const TrainingOptions& options, const dataset::Dataset& dataset) {
  if (absl::Status status = CheckMirror(options.common.augmentation(), dataset.skeleton);
      !status.ok()) {
    return status;
  }
  const std::vector<std::string> subjects = dataset.Subjects();
  for (const std::string& name : options.common.validation().subjects()) {
    if (std::find(subjects.begin(), subjects.end(), name) != subjects.end()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("validation.subjects: expected subjects of the data (",
                     subjects.empty() ? "it names none" : absl::StrJoin(subjects, ", "), "), got ",
                     base::Quoted(name)));
  }
  return absl::OkStatus();
}

}  // namespace duet::training
