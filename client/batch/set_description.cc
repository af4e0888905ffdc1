#include "client/batch/set_description.h"

#include <algorithm>
#include <limits>

#include "absl/strings/str_cat.h"
#include "duet/batch/v1/batch.pb.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::client::batch {
namespace {

namespace v1 = ::duet::batch::v1;

constexpr size_t kMaxModels = 1000;
constexpr size_t kMaxClasses = 256;
constexpr size_t kMaxTextBytes = 1 << 20;

nlohmann::ordered_json ModelJson(const DescribedModel& model) {
  nlohmann::ordered_json json = {
      {"weights_sha256", model.weights_sha256}, {"terms", model.terms},
      {"description", model.description},       {"interaction_classes", model.interaction_classes},
      {"frame_rate_hz", model.frame_rate_hz},   {"samples", model.samples}};
  if (model.free_for_all_uses) json["free_for_all_uses"] = *model.free_for_all_uses;
  return json;
}

DescribedModel ReadModel(const nlohmann::json& json, base::ObjectReader* parent) {
  base::ObjectReader reader(json, "models");
  DescribedModel model;
  model.weights_sha256 = reader.String("weights_sha256", kMaxTextBytes);
  model.terms = reader.String("terms", kMaxTextBytes);
  model.description = reader.String("description", kMaxTextBytes);
  model.interaction_classes = reader.Strings("interaction_classes", kMaxClasses);
  model.frame_rate_hz = reader.Number("frame_rate_hz", 0, std::numeric_limits<double>::max());
  model.samples = reader.Bool("samples");
  if (reader.Has("free_for_all_uses")) model.free_for_all_uses = reader.Bool("free_for_all_uses");
  parent->Update(reader.Finish());
  return model;
}

Splits ReadSplits(const nlohmann::json& json, base::ObjectReader* parent) {
  base::ObjectReader reader(json, "splits");
  Splits splits;
  splits.validation = reader.Number("validation", 0, 1);
  splits.test = reader.Number("test", 0, 1);
  parent->Update(reader.Finish());
  return splits;
}

}  // namespace

std::vector<std::string> AllClasses(const SetDescription& description) {
  std::vector<std::string> all;
  for (const DescribedModel& model : description.models) {
    for (const std::string& name : model.interaction_classes) {
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  }
  return all;
}

std::string FormatName(Format format) {
  // The enums have the same order; the proto's begins at 1.
  return v1::Format_Name(static_cast<v1::Format>(static_cast<int>(format) + v1::FORMAT_BVH));
}

DescribedModel Describe(const ModelInfo& model) {
  return {model.weights_sha256,
          model.terms,
          model.free_for_all_uses,
          model.description,
          model.interaction_classes,
          model.frame_rate_hz,
          model.samples};
}

nlohmann::ordered_json ToJson(const SetDescription& description) {
  nlohmann::ordered_json models = nlohmann::ordered_json::array();
  for (const DescribedModel& model : description.models) models.push_back(ModelJson(model));
  nlohmann::ordered_json formats = nlohmann::ordered_json::array();
  for (const Format format : description.formats) formats.push_back(FormatName(format));
  nlohmann::ordered_json json = {{"models", models}, {"formats", formats}};
  if (description.frame_rate_hz) json["frame_rate_hz"] = *description.frame_rate_hz;
  if (description.splits.any()) {
    json["splits"] = {{"validation", description.splits.validation},
                      {"test", description.splits.test}};
  }
  return json;
}

absl::StatusOr<SetDescription> SetDescriptionFromJson(const nlohmann::json& json) {
  base::ObjectReader reader(json, "description");
  SetDescription description;
  for (const nlohmann::json& model : reader.Array("models", kMaxModels)) {
    description.models.push_back(ReadModel(model, &reader));
  }
  for (const std::string& name : reader.Strings("formats", v1::Format_ARRAYSIZE)) {
    v1::Format format = v1::FORMAT_UNSPECIFIED;
    if (!v1::Format_Parse(name, &format) || format == v1::FORMAT_UNSPECIFIED) {
      reader.Fail("formats", absl::StrCat("expected a format, got ", base::Quoted(name)));
    }
    description.formats.push_back(static_cast<Format>(format - v1::FORMAT_BVH));
  }
  if (reader.Has("frame_rate_hz")) {
    description.frame_rate_hz = reader.Number("frame_rate_hz", 0, motion::kMaxFrameRateHz);
  }
  if (reader.Has("splits")) {
    description.splits = ReadSplits(reader.Object("splits"), &reader);
  }
  absl::Status status = reader.Finish();
  if (!status.ok()) return status;
  return description;
}

}  // namespace duet::client::batch
