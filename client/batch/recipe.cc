#include "client/batch/recipe.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/batch/text_values.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/base/text.h"
#include "model/messages/message_text.h"
#include "model/motion/motion_limits.h"

namespace duet::client::batch {
namespace {

constexpr float kMaxAbsWeight = 2;
constexpr uint32_t kMaxSamples = 10'000;
constexpr uint32_t kMaxMixes = 10'000;
constexpr uint32_t kMaxRetries = 100;
constexpr uint32_t kMaxCandidates = 16;
constexpr float kMinUprightCosine = 0.70710678f;  // of 45 degrees

// Of the names in a message.
constexpr size_t kLongestField = 200, kLongestValue = 200;

// Stores the first error.
class Checker {
 public:
  void Expect(bool good, const std::string& field, const std::string& got, const char* expected) {
    if (good || !status_.ok()) return;
    status_ = absl::InvalidArgumentError(absl::StrCat(base::Printable(field, kLongestField),
                                                      ": expected ", expected, ", got ",
                                                      base::Printable(got, kLongestValue)));
  }
  void Weight(const std::string& field, float weight) {
    Expect(std::abs(weight) <= kMaxAbsWeight, field, absl::StrCat(weight), "a number from -2 to 2");
  }
  void Count(const std::string& field, uint32_t value, uint32_t low, uint32_t high) {
    Expect(value >= low && value <= high, field, absl::StrCat(value),
           absl::StrCat("a number from ", low, " to ", high).c_str());
  }
  template <typename Range>
  void Different(const std::string& field, const Range& values) {
    std::set<typename Range::value_type> seen;
    for (const auto& value : values) {
      Expect(seen.insert(value).second, field, absl::StrCat(value, " twice"), "each once");
    }
  }
  const absl::Status& status() const { return status_; }

 private:
  absl::Status status_;
};

void CheckLabels(const v1::Labels& labels, const std::string& field, Checker* check) {
  check->Expect(labels.weights_size() > 0, field + ".weights", "none", "one or more");
  for (const auto& [name, weight] : labels.weights()) {
    check->Expect(!name.empty(), field + ".weights", "an empty name", "a class");
    check->Weight(absl::StrCat(field, ".weights[", name, "]"), weight);
  }
}

void CheckMixes(const v1::Mixes& mixes, const std::string& field, Checker* check) {
  check->Count(field + ".count", mixes.count(), 1, kMaxMixes);
  check->Different(field + ".classes", mixes.classes());
  const uint32_t in_mix = ClassesInMix(mixes);
  check->Count(field + ".classes_in_mix", in_mix, 1, 1000);
  check->Expect(mixes.classes_size() == 0 || in_mix <= static_cast<uint32_t>(mixes.classes_size()),
                field + ".classes_in_mix", absl::StrCat(in_mix), "no more than there are classes");
  const WeightRange range = RangeOf(mixes);
  check->Weight(field + ".min_weight", range.min);
  check->Weight(field + ".max_weight", range.max);
  check->Expect(range.min <= range.max, field + ".min_weight", absl::StrCat(range.min),
                "at most max_weight");
}

bool IsName(const std::string& name) {
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return absl::ascii_isalnum(c) || c == '_'; });
}

void CheckReaction(const v1::Reaction& reaction, const std::string& field, Checker* check) {
  check->Expect(IsName(reaction.name()), field + ".name", base::Quoted(reaction.name()),
                "letters, digits and underscores");
  switch (reaction.kind_case()) {
    case v1::Reaction::kLabels:
      return CheckLabels(reaction.labels(), field + ".labels", check);
    case v1::Reaction::kMixes:
      return CheckMixes(reaction.mixes(), field + ".mixes", check);
    case v1::Reaction::kEachClass:
      return check->Different(field + ".each_class.classes", reaction.each_class().classes());
    case v1::Reaction::KIND_NOT_SET:
      check->Expect(false, field, "nothing", "one of labels, mixes and each_class");
  }
}

LeaderInput ReadInput(const v1::LeaderInput& proto, Checker* check) {
  LeaderInput input;
  formats::ReadOptions& reading = input.reading;
  check->Expect(v1::Side_IsValid(proto.side()), "input.side", absl::StrCat(proto.side()), "a side");
  if (proto.side() != v1::SIDE_UNSPECIFIED) input.side = proto.side();
  input.starts_as_other_person = proto.follower_start() == v1::FOLLOWER_START_OTHER_PERSON;
  if (proto.has_frame_rate_hz()) reading.frame_rate_hz = proto.frame_rate_hz();
  if (proto.has_metres_per_unit()) reading.metres_per_unit = proto.metres_per_unit();
  check->Expect(reading.frame_rate_hz.value_or(1) > 0, "input.frame_rate_hz",
                absl::StrCat(proto.frame_rate_hz()), "more than 0");
  check->Expect(reading.metres_per_unit.value_or(1) > 0, "input.metres_per_unit",
                absl::StrCat(proto.metres_per_unit()), "more than 0");
  if (proto.up_size() > 0) {
    const auto& up = proto.up();
    input.up = proto.up_size() == 3 ? motion::Vec3{up[0], up[1], up[2]} : motion::Vec3{};
    check->Expect(IsFinite(*input.up) && input.up->y > kMinUprightCosine * Norm(*input.up),
                  "input.up", absl::StrJoin(up, ","), "X,Y,Z less than 45 degrees from 0,1,0");
  }
  reading.joint_overrides.insert(proto.joint_map().begin(), proto.joint_map().end());
  return input;
}

// Every limit is 0 or more.
void CheckFilter(const v1::QualityFilter& filter, Checker* check) {
  const google::protobuf::Descriptor& fields = *filter.GetDescriptor();
  for (int i = 0; i < fields.field_count(); ++i) {
    const google::protobuf::FieldDescriptor* const field = fields.field(i);
    if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
    const double limit = filter.GetReflection()->GetDouble(filter, field);
    check->Expect(limit >= 0, absl::StrCat("filter.", field->name()), absl::StrCat(limit),
                  "0 or more");
  }
  check->Count("filter.retries_per_item", filter.retries_per_item(), 0, kMaxRetries);
}

void CheckOutput(const v1::Output& output, Checker* check) {
  check->Expect(output.formats_size() > 0, "output.formats", "none", "one or more");
  for (const int format : output.formats()) {
    check->Expect(v1::Format_IsValid(format) && format != v1::FORMAT_UNSPECIFIED, "output.formats",
                  absl::StrCat(format), "FORMAT_BVH, FORMAT_NPY or FORMAT_GLB");
  }
  check->Different("output.formats", output.formats());
  const double rate_hz = output.has_frame_rate_hz() ? output.frame_rate_hz() : 1;
  check->Expect(rate_hz > 0 && rate_hz <= motion::kMaxFrameRateHz, "output.frame_rate_hz",
                absl::StrCat(rate_hz), "above 0, at most 1000");
}

void ReadModels(const v1::Recipe& proto, Checker* check, Recipe* recipe) {
  check->Different("models", proto.models());
  for (const std::string& name : proto.models()) {
    const absl::StatusOr<ModelChoice> choice = ParseModelChoice(name);
    check->Expect(choice.ok(), "models", base::Quoted(name), "NAME, NAME@VERSION or NAME:LABEL");
    if (choice.ok()) recipe->models.push_back(*choice);
  }
  if (recipe->models.empty()) recipe->models.emplace_back();
}

// Without the digest and the JSON.
absl::StatusOr<Recipe> FromProto(const v1::Recipe& proto) {
  Checker check;
  Recipe recipe;
  recipe.seed = proto.seed();
  ReadModels(proto, &check, &recipe);
  for (int i = 0; i < proto.reactions_size(); ++i) {
    CheckReaction(proto.reactions(i), absl::StrCat("reactions[", i, "]"), &check);
  }
  recipe.reactions = proto.reactions();
  if (proto.has_samples()) {
    check.Count("samples", proto.samples(), 1, kMaxSamples);
    recipe.samples = static_cast<int>(proto.samples());
  }
  if (proto.has_variety()) recipe.variety = proto.variety();
  check.Expect(recipe.variety >= 0 && recipe.variety <= 2, "variety", absl::StrCat(recipe.variety),
               "a number from 0 to 2");
  if (proto.has_candidates()) {
    check.Count("candidates", proto.candidates(), 1, kMaxCandidates);
    recipe.candidates = static_cast<int>(proto.candidates());
  }
  recipe.input = ReadInput(proto.input(), &check);
  CheckFilter(proto.filter(), &check);
  recipe.filter = proto.filter();
  CheckOutput(proto.output(), &check);
  recipe.output = proto.output();
  if (!check.status().ok()) return check.status();
  return recipe;
}

constexpr std::size_t kMaxRecipeBytes = std::size_t{4} << 20;

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

}  // namespace

absl::StatusOr<Recipe> ParseRecipe(absl::string_view text, bool json) {
  v1::Recipe parsed;
  absl::Status status = messages::ParseMessage(
      text, json ? messages::MessageSyntax::kJson : messages::MessageSyntax::kTextFormat, &parsed);
  if (!status.ok()) return status;
  absl::StatusOr<Recipe> recipe = FromProto(parsed);
  if (!recipe.ok()) return recipe;
  recipe->digest = Digest(parsed);
  recipe->json = ToJson(parsed);
  return recipe;
}

absl::StatusOr<Recipe> ReadRecipe(const std::filesystem::path& path) {
  const absl::StatusOr<std::string> text = base::ReadFile(path, kMaxRecipeBytes, "a recipe");
  if (!text.ok()) return text.status();
  absl::StatusOr<Recipe> recipe = ParseRecipe(*text, path.extension() == ".json");
  if (recipe.ok()) return recipe;
  return absl::Status(recipe.status().code(),
                      absl::StrCat(path.string(), ": ", recipe.status().message()));
}

std::string ToJson(const google::protobuf::Message& message, bool add_whitespace) {
  std::string json;
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.add_whitespace = add_whitespace;
  // Cannot fail for a message without Any.
  (void)google::protobuf::util::MessageToJsonString(message, &json, options);
  return json;
}

std::string DescribeDifference(const std::string& before, const std::string& now) {
  v1::Recipe old_recipe, new_recipe;
  const auto read = [](const std::string& json, v1::Recipe* recipe) {
    return messages::ParseMessage(json, messages::MessageSyntax::kJson, recipe).ok();
  };
  if (!read(before, &old_recipe) || !read(now, &new_recipe)) return "";
  std::string text;
  google::protobuf::util::MessageDifferencer differencer;
  differencer.ReportDifferencesToString(&text);
  differencer.Compare(old_recipe, new_recipe);
  return absl::StrJoin(absl::StrSplit(text, '\n', absl::SkipEmpty()), "; ");
}

WeightRange RangeOf(const v1::Mixes& mixes) {
  return {mixes.has_min_weight() ? mixes.min_weight() : 0.25f,
          mixes.has_max_weight() ? mixes.max_weight() : 1};
}

uint32_t ClassesInMix(const v1::Mixes& mixes) {
  return mixes.has_classes_in_mix() ? mixes.classes_in_mix() : 2;
}

Labels ToLabels(const v1::Labels& proto) {
  Labels labels;
  for (const auto& [name, weight] : proto.weights()) labels.push_back({name, weight});
  SortByClass(&labels);
  return labels;
}

}  // namespace duet::client::batch
