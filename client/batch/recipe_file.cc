#include "client/batch/recipe_file.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>

#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/batch/recipe_conversion.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/base/strict_json.h"
#include "model/classifier/classifier_files.h"
#include "model/messages/message_text.h"
#include "model/retargeting/joint_table.h"

namespace duet::client::batch {
namespace {

constexpr std::size_t kMaxRecipeBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxTableBytes = std::size_t{1} << 20;

// Equal for files with the same content: map entries are sorted by key.
std::string Digest(const v1::Recipe& recipe) {
  std::string bytes;
  google::protobuf::io::StringOutputStream stream(&bytes);
  {
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    recipe.SerializeToCodedStream(&coded);
  }
  return base::Sha256Hex(bytes);
}

std::string ToJson(const v1::Recipe& recipe) {
  std::string json;
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  // Cannot fail for a message without Any.
  (void)google::protobuf::util::MessageToJsonString(recipe, &json, options);
  return json;
}

void Apply(const RecipeOverrides& overrides, v1::Recipe* recipe) {
  if (overrides.retries_per_item) {
    recipe->mutable_filter()->set_retries_per_item(
        static_cast<uint32_t>(*overrides.retries_per_item));
  }
  if (!overrides.input_format.empty()) {
    recipe->mutable_input()->set_format(overrides.input_format);
  }
  if (!overrides.level.empty()) recipe->mutable_input()->set_level(overrides.level);
  if (overrides.frame_rate_hz) {
    recipe->mutable_output()->set_frame_rate_hz(*overrides.frame_rate_hz);
  }
}

// Merges the joint map file that the recipe names into its joint map.
absl::Status TakeJointTable(const std::filesystem::path& folder, v1::LeaderInput* input) {
  if (input->joint_map_file().empty()) return absl::OkStatus();
  const std::filesystem::path path = folder / input->joint_map_file();
  const absl::StatusOr<std::string> text =
      base::ReadFile(path, kMaxTableBytes, "a table of joints");
  if (!text.ok()) return text.status();
  const absl::StatusOr<retargeting::JointOverrides> table =
      retargeting::ParseJointTable(*text, path.string());
  if (!table.ok()) return table.status();
  input->clear_joint_map_file();
  input->mutable_joint_map()->insert(table->begin(), table->end());  // keeps existing entries
  return absl::OkStatus();
}

// Reads the classifier that the recipe names, and replaces its path by its digest.
absl::StatusOr<std::shared_ptr<const classifier::Classifier>> TakeClassifier(
    const std::filesystem::path& folder, v1::ClassifierFilter* filter) {
  if (filter->model().empty()) return nullptr;
  absl::StatusOr<classifier::StoredClassifier> stored =
      classifier::ReadClassifier(folder / filter->model());
  if (!stored.ok()) return stored.status();
  filter->set_model(stored->sha256);
  return std::make_shared<const classifier::Classifier>(std::move(stored->classifier));
}

using nlohmann::json;

constexpr size_t kDescribed = 5;

// All values except objects and arrays, by path: "reactions[0].labels.weights.kick".
using Fields = std::map<std::string, json>;

void Flatten(const json& value, const std::string& path, Fields* fields) {
  if (value.is_object() && !value.empty()) {
    for (const auto& [name, member] : value.items()) {
      Flatten(member, path.empty() ? name : absl::StrCat(path, ".", name), fields);
    }
  } else if (value.is_array() && !value.empty()) {
    for (size_t i = 0; i < value.size(); ++i) {
      Flatten(value[i], absl::StrCat(path, "[", i, "]"), fields);
    }
  } else if (!path.empty()) {
    (*fields)[path] = value;
  }
}

std::string ShownAt(const Fields& fields, const std::string& path) {
  const auto found = fields.find(path);
  return found == fields.end() ? "none" : base::Shown(found->second);
}

}  // namespace

absl::StatusOr<Recipe> ParseRecipe(absl::string_view text, bool json,
                                   const std::filesystem::path& folder,
                                   const RecipeOverrides& overrides) {
  v1::Recipe parsed;
  absl::Status status = messages::ParseMessage(
      text, json ? messages::MessageSyntax::kJson : messages::MessageSyntax::kTextFormat, &parsed);
  if (status.ok() && parsed.has_input()) status = TakeJointTable(folder, parsed.mutable_input());
  absl::StatusOr<std::shared_ptr<const classifier::Classifier>> classifier = nullptr;
  if (status.ok() && parsed.filter().has_classifier()) {
    classifier = TakeClassifier(folder, parsed.mutable_filter()->mutable_classifier());
    status = classifier.status();
  }
  if (!status.ok()) return status;
  Apply(overrides, &parsed);
  absl::StatusOr<Recipe> recipe = FromProto(parsed);
  if (!recipe.ok()) return recipe;
  recipe->digest = Digest(parsed);
  recipe->json = ToJson(parsed);
  recipe->filter.classifier = *std::move(classifier);
  return recipe;
}

absl::StatusOr<Recipe> ReadRecipe(const std::filesystem::path& path,
                                  const RecipeOverrides& overrides) {
  const absl::StatusOr<std::string> text = base::ReadFile(path, kMaxRecipeBytes, "a recipe");
  if (!text.ok()) return text.status();
  absl::StatusOr<Recipe> recipe =
      ParseRecipe(*text, path.extension() == ".json", path.parent_path(), overrides);
  if (recipe.ok()) return recipe;
  return absl::Status(recipe.status().code(),
                      absl::StrCat(path.string(), ": ", recipe.status().message()));
}

std::string DescribeDifference(const std::string& expected, const std::string& got) {
  const json before = json::parse(expected, nullptr, false), now = json::parse(got, nullptr, false);
  if (!before.is_object() || !now.is_object()) return "";
  Fields old_fields, new_fields;
  Flatten(before, "", &old_fields);
  Flatten(now, "", &new_fields);
  std::set<std::string> paths;
  for (const auto& [path, value] : old_fields) paths.insert(path);
  for (const auto& [path, value] : new_fields) paths.insert(path);
  std::vector<std::string> described;
  size_t differing = 0;
  for (const std::string& path : paths) {
    const std::string was = ShownAt(old_fields, path), is = ShownAt(new_fields, path);
    if (was == is || ++differing > kDescribed) continue;
    described.push_back(absl::StrCat(path, ": expected ", was, ", got ", is));
  }
  if (differing > kDescribed) {
    described.push_back(absl::StrCat("and ", differing - kDescribed, " more"));
  }
  return absl::StrJoin(described, "; ");
}

}  // namespace duet::client::batch
