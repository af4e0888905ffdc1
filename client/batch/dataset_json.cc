#include "client/batch/dataset_json.h"

#include <algorithm>
#include <optional>

#include "absl/strings/str_cat.h"
#include "client/batch/capture_layout.h"
#include "client/batch/encode.h"
#include "model/motion/coordinates.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr char kFormat[] = "duet-batch";
constexpr int kFormatVersion = 1;

bool Same(const motion::Skeleton& a, const motion::Skeleton& b) {
  return a.joint_names == b.joint_names && a.Parents() == b.Parents() && a.root == b.root;
}

// Each skeleton once, at the index that SkeletonIndices returns.
ordered_json SkeletonsJson(const std::vector<motion::Skeleton>& skeletons) {
  ordered_json array = ordered_json::array();
  const std::vector<int> indices = SkeletonIndices(skeletons);
  for (size_t model = 0; model < skeletons.size(); ++model) {
    if (indices[model] != static_cast<int>(array.size())) continue;
    const motion::Skeleton& skeleton = skeletons[model];
    array.push_back({{"joint_names", skeleton.joint_names},
                     {"parents", skeleton.Parents()},
                     {"root_joint", skeleton.joint_names[static_cast<size_t>(skeleton.root)]}});
  }
  return array;
}

void AddText(const char* name, const std::string& text, ordered_json* object) {
  if (!text.empty()) (*object)[name] = text;
}

ordered_json ModelsJson(const SetSource& source, const DoneItems& done) {
  const std::vector<int> skeletons = SkeletonIndices(source.skeletons);
  ordered_json array = ordered_json::array();
  for (size_t i = 0; i < source.models.size(); ++i) {
    const ModelInfo& about = source.models[i];
    ordered_json model = {{"name", NameOfModel(about)}};
    AddText("weights_sha256", about.weights_sha256, &model);
    AddText("terms", about.terms, &model);
    model["free_for_all_uses"] = about.free_for_all_uses;
    AddText("description", about.description, &model);
    model["interaction_classes"] = about.interaction_classes;
    model["skeleton"] = skeletons[i];
    if (about.frame_rate_hz > 0) model["frame_rate_hz"] = about.frame_rate_hz;
    model["samples"] = about.samples;
    const auto made_by = done.made_by.find(NameOfModel(about));
    if (made_by != done.made_by.end()) AddMadeBy(made_by->second, &model);
    array.push_back(std::move(model));
  }
  return array;
}

// The classes of all models, each once, in the order of the models.
std::vector<std::string> AllClasses(const std::vector<ModelInfo>& models) {
  std::vector<std::string> all;
  for (const ModelInfo& model : models) {
    for (const std::string& name : model.interaction_classes) {
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  }
  return all;
}

ordered_json FilesJson(v1::Format format) {
  ordered_json files = {{"format", v1::Format_Name(format)},
                        {"endings", EndingsOf(format)},
                        {"unit", format == v1::FORMAT_BVH ? "centimetres" : "metres"},
                        {"up_axis", motion::UpAxisName(motion::UpAxis::kYUp)}};
  if (format == v1::FORMAT_NPY) {
    files["dtype"] = "float32";
    files["shape"] = {"people", "frames", "joints", "coordinates"};
  }
  return files;
}

ordered_json AllFilesJson(const v1::Output& output) {
  ordered_json array = ordered_json::array();
  if (const dataset::DatasetLayout* const captures = CapturesOf(output.layout())) {
    array.push_back({{"endings", {".txt"}},
                     {"unit", motion::LengthUnitName(captures->coordinates.unit)},
                     {"up_axis", motion::UpAxisName(captures->coordinates.up_axis)}});
  }
  for (const int format : output.formats()) {
    array.push_back(FilesJson(static_cast<v1::Format>(format)));
  }
  return array;
}

ordered_json RatesJson(const std::map<double, int64_t>& items_by_rate) {
  ordered_json array = ordered_json::array();
  for (const auto& [rate_hz, items] : items_by_rate) {
    array.push_back({{"frame_rate_hz", rate_hz}, {"items", items}});
  }
  return array;
}

std::optional<double> CommonRate(const v1::Output& output, const DoneItems& done) {
  const std::optional<double> rate_hz = RateOf(output);
  if (rate_hz || done.items_by_rate.size() != 1) return rate_hz;
  return done.items_by_rate.begin()->first;
}

}  // namespace

void DoneItems::Add(const ordered_json& record) {
  frames += record["frames"].get<uint64_t>();
  ++items_by_rate[record["frame_rate_hz"].get<double>()];
  if (const std::optional<MadeBy> how = MadeByOf(record)) {
    made_by.try_emplace(record["model"].get<std::string>(), *how);
  }
}

std::vector<int> SkeletonIndices(const std::vector<motion::Skeleton>& skeletons) {
  std::vector<int> indices;
  int count = 0;
  for (size_t i = 0; i < skeletons.size(); ++i) {
    size_t first = 0;
    while (!Same(skeletons[first], skeletons[i])) ++first;
    indices.push_back(first < i ? indices[first] : count++);
  }
  return indices;
}

std::string NameOfModel(const ModelInfo& model) {
  return absl::StrCat(model.name, "@", model.version);
}

std::string DatasetJson(const SetSource& source, const SetCounts& counts, int64_t planned,
                        const DoneItems& done) {
  const v1::Output& output = source.recipe.output;
  ordered_json dataset = {{"format", kFormat},
                          {"format_version", kFormatVersion},
                          {"recipe_sha256", source.recipe.digest},
                          {"items",
                           {{"done", counts.done},
                            {"rejected", counts.rejected},
                            {"failed", counts.failed},
                            {"missing", planned - counts.done - counts.rejected - counts.failed}}},
                          {"frames", done.frames}};
  if (const std::optional<double> rate_hz = CommonRate(output, done)) {
    dataset["frame_rate_hz"] = *rate_hz;
  }
  dataset["frame_rates"] = RatesJson(done.items_by_rate);
  dataset["skeletons"] = SkeletonsJson(source.skeletons);
  dataset["models"] = ModelsJson(source, done);
  dataset["interaction_classes"] = AllClasses(source.models);
  dataset["files"] = AllFilesJson(output);
  dataset["layout"] = v1::Layout_Name(output.layout());
  return dataset.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace duet::client::batch
