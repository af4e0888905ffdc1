#include "client/batch/dataset_json.h"

#include "client/batch/capture_layout.h"
#include "client/batch/item_table.h"
#include "client/batch/split.h"
#include "client/batch/text_values.h"
#include "duet/batch/v1/batch.pb.h"
#include "model/motion/coordinates.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;
namespace v1 = ::duet::batch::v1;

constexpr char kFormat[] = "duet-batch";
constexpr int kFormatVersion = 1;

// The enums have the order of the proto's, which also have an UNSPECIFIED value first.
std::string LayoutName(Layout layout) {
  return v1::Layout_Name(static_cast<v1::Layout>(static_cast<int>(layout) + 1));
}

// In the order of the proto, whose numbers differ from the enum's.
std::string PackingName(Packing packing) {
  if (packing == Packing::kTar) return v1::Packing_Name(v1::PACKING_TAR);
  return v1::Packing_Name(packing == Packing::kNpz ? v1::PACKING_NPZ : v1::PACKING_NONE);
}

bool Same(const motion::Skeleton& a, const motion::Skeleton& b) {
  return a.joint_names == b.joint_names && a.Parents() == b.Parents() && a.root == b.root;
}

ordered_json SkeletonJson(const motion::Skeleton& skeleton) {
  return {{"joint_names", skeleton.joint_names},
          {"parents", skeleton.Parents()},
          {"root_joint", skeleton.joint_names[static_cast<size_t>(skeleton.root)]}};
}

// Each skeleton once, at the index that SkeletonIndices returns.
ordered_json SkeletonsJson(const std::vector<motion::Skeleton>& skeletons) {
  ordered_json array = ordered_json::array();
  const std::vector<int> indices = SkeletonIndices(skeletons);
  for (size_t model = 0; model < skeletons.size(); ++model) {
    if (indices[model] == static_cast<int>(array.size())) {
      array.push_back(SkeletonJson(skeletons[model]));
    }
  }
  return array;
}

void AddText(const char* name, const std::string& text, ordered_json* object) {
  if (!text.empty()) (*object)[name] = text;
}

ordered_json ModelsJson(const JobIdentity& identity, const DoneItems& done) {
  const std::vector<int> skeletons = SkeletonIndices(identity.skeletons);
  const std::vector<DescribedModel>& described = identity.description.models;
  ordered_json array = ordered_json::array();
  for (size_t i = 0; i < identity.models.size(); ++i) {
    ordered_json model = {{"name", ModelText(identity.models[i])}};
    // A set that was begun by an earlier version has no descriptions.
    const DescribedModel about = i < described.size() ? described[i] : DescribedModel();
    AddText("weights_sha256", about.weights_sha256, &model);
    AddText("terms", about.terms, &model);
    if (about.free_for_all_uses) model["free_for_all_uses"] = *about.free_for_all_uses;
    AddText("description", about.description, &model);
    model["interaction_classes"] = about.interaction_classes;
    model["skeleton"] = skeletons[i];
    if (about.frame_rate_hz > 0) model["frame_rate_hz"] = about.frame_rate_hz;
    model["samples"] = about.samples;
    const MadeBy* const made_by = done.made_by(ModelText(identity.models[i]));
    if (made_by != nullptr) AddMadeBy(*made_by, &model);
    array.push_back(std::move(model));
  }
  return array;
}

std::vector<std::string> EndingsOf(Format format) {
  switch (format) {
    case Format::kBvh:
      return {".leader.bvh", ".follower.bvh"};
    case Format::kCsv:
      return {".csv"};
    case Format::kNpy:
      return {".npy"};
    case Format::kJson:
      return {".json"};
    case Format::kGlb:
      return {".glb"};
    case Format::kUsda:
      break;
  }
  return {".usda"};
}

ordered_json FilesJson(Format format) {
  ordered_json files = {{"format", FormatName(format)},
                        {"endings", EndingsOf(format)},
                        {"unit", format == Format::kBvh ? "centimetres" : "metres"},
                        {"up_axis", motion::UpAxisName(motion::UpAxis::kYUp)}};
  if (format == Format::kNpy) {
    files["dtype"] = "float32";
    files["shape"] = {"people", "frames", "joints", "coordinates"};
  }
  return files;
}

ordered_json AllFilesJson(const JobIdentity& identity) {
  ordered_json array = ordered_json::array();
  if (const dataset::DatasetLayout* const captures = CapturesOf(identity.layout)) {
    array.push_back({{"endings", {".txt"}},
                     {"unit", motion::LengthUnitName(captures->coordinates.unit)},
                     {"up_axis", motion::UpAxisName(captures->coordinates.up_axis)}});
  }
  for (const Format format : identity.description.formats) array.push_back(FilesJson(format));
  return array;
}

ordered_json RatesJson(const std::map<double, int64_t>& items_by_rate) {
  ordered_json array = ordered_json::array();
  for (const auto& [rate_hz, items] : items_by_rate) {
    array.push_back({{"frame_rate_hz", rate_hz}, {"items", items}});
  }
  return array;
}

ordered_json SplitsJson(const SetDescription& description, const DoneItems& done) {
  ordered_json array = ordered_json::array();
  for (const std::string& name : SplitNames(description.splits)) {
    ordered_json split = {
        {"name", name}, {"items", done.items_of(name)}, {"table", TablePath(name)}};
    if (!done.shards_of(name).empty()) split["shards"] = done.shards_of(name);
    array.push_back(std::move(split));
  }
  return array;
}

std::optional<double> CommonRate(const SetDescription& description, const DoneItems& done) {
  if (description.frame_rate_hz) return description.frame_rate_hz;
  if (done.items_by_rate().size() != 1) return std::nullopt;
  return done.items_by_rate().begin()->first;
}

}  // namespace

void DoneItems::Add(const ordered_json& record) {
  frames_ += record["frames"].get<uint64_t>();
  ++items_by_rate_[record["frame_rate_hz"].get<double>()];
  if (const std::optional<MadeBy> made_by = MadeByOf(record)) {
    made_by_.try_emplace(record["model"].get<std::string>(), *made_by);
  }
  const auto named = record.find("split");
  OfSplit& split = splits_[named == record.end() ? kTrain : named->get<std::string>()];
  ++split.items;
  const auto shard = record.find("shard");
  if (shard == record.end() || !known_shards_.insert(shard->get<std::string>()).second) return;
  shards_.push_back(*shard);
  split.shards.push_back(*shard);
}

const MadeBy* DoneItems::made_by(const std::string& model) const {
  const auto found = made_by_.find(model);
  return found == made_by_.end() ? nullptr : &found->second;
}

const DoneItems::OfSplit& DoneItems::Of(const std::string& split) const {
  static const OfSplit* const kNothing = new OfSplit;
  const auto found = splits_.find(split);
  return found == splits_.end() ? *kNothing : found->second;
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

std::string DatasetJson(const JobIdentity& identity, const SetCounts& counts, int64_t planned,
                        const DoneItems& done, bool packed) {
  ordered_json dataset = {{"format", kFormat},
                          {"format_version", kFormatVersion},
                          {"recipe_sha256", identity.recipe_digest},
                          {"items",
                           {{"done", counts.done},
                            {"rejected", counts.rejected},
                            {"failed", counts.failed},
                            {"missing", planned - counts.done - counts.rejected - counts.failed}}},
                          {"frames", done.frames()}};
  if (const std::optional<double> rate_hz = CommonRate(identity.description, done)) {
    dataset["frame_rate_hz"] = *rate_hz;
  }
  dataset["frame_rates"] = RatesJson(done.items_by_rate());
  dataset["skeletons"] = SkeletonsJson(identity.skeletons);
  dataset["models"] = ModelsJson(identity, done);
  dataset["interaction_classes"] = AllClasses(identity.description);
  dataset["files"] = AllFilesJson(identity);
  dataset["layout"] = LayoutName(identity.layout);
  dataset["packing"] = PackingName(identity.packing);
  if (packed) dataset["shards"] = done.shards();
  dataset["splits"] = SplitsJson(identity.description, done);
  return dataset.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace duet::client::batch
