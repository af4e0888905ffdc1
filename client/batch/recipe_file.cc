#include "client/batch/recipe_file.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <cstddef>
#include <string>

#include "absl/strings/str_cat.h"
#include "client/batch/recipe_conversion.h"
#include "model/base/file.h"
#include "model/base/sha256.h"

namespace duet::client::batch {
namespace {

constexpr std::size_t kMaxRecipeBytes = std::size_t{4} << 20;

// Keeps the first error of a text-format file.
class FirstError final : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, google::protobuf::io::ColumnNumber column,
                const std::string& message) override {
    // Both count from 0; -1 is the file as a whole.
    if (text_.empty()) text_ = absl::StrCat("line ", line + 1, ":", column + 1, ": ", message);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

absl::StatusOr<v1::Recipe> ParseJson(absl::string_view text) {
  v1::Recipe recipe;
  const auto status = google::protobuf::util::JsonStringToMessage(std::string(text), &recipe);
  if (status.ok()) return recipe;
  return absl::InvalidArgumentError(std::string(status.message()));
}

absl::StatusOr<v1::Recipe> ParseTextFormat(absl::string_view text) {
  v1::Recipe recipe;
  FirstError error;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  if (parser.ParseFromString(std::string(text), &recipe)) return recipe;
  return absl::InvalidArgumentError(error.text());
}

// The same for two files that say the same: maps are written by key.
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

v1::Packing ToProto(Packing packing) {
  switch (packing) {
    case Packing::kTar:
      return v1::PACKING_TAR;
    case Packing::kNpz:
      return v1::PACKING_NPZ;
    case Packing::kNone:
      break;
  }
  return v1::PACKING_NONE;
}

void Apply(const RecipeOverrides& overrides, v1::Recipe* recipe) {
  if (overrides.packing) recipe->mutable_output()->set_packing(ToProto(*overrides.packing));
  if (overrides.retries_per_item) {
    recipe->mutable_filter()->set_retries_per_item(
        static_cast<uint32_t>(*overrides.retries_per_item));
  }
}

}  // namespace

absl::StatusOr<Recipe> ParseRecipe(absl::string_view text, bool json,
                                   const RecipeOverrides& overrides) {
  absl::StatusOr<v1::Recipe> parsed = json ? ParseJson(text) : ParseTextFormat(text);
  if (!parsed.ok()) return parsed.status();
  Apply(overrides, &*parsed);
  absl::StatusOr<Recipe> recipe = FromProto(*parsed);
  if (recipe.ok()) recipe->digest = Digest(*parsed);
  return recipe;
}

absl::StatusOr<Recipe> ReadRecipe(const std::filesystem::path& path,
                                  const RecipeOverrides& overrides) {
  const absl::StatusOr<std::string> text = base::ReadFile(path, kMaxRecipeBytes, "a recipe");
  if (!text.ok()) return text.status();
  absl::StatusOr<Recipe> recipe = ParseRecipe(*text, path.extension() == ".json", overrides);
  if (recipe.ok()) return recipe;
  return absl::Status(recipe.status().code(),
                      absl::StrCat(path.string(), ": ", recipe.status().message()));
}

}  // namespace duet::client::batch
