#include "client/batch/index.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/answer.h"
#include "client/batch/durable_file.h"
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

ordered_json ModelsJson(const SetSource& source, const SetCounts& counts) {
  const std::vector<int> skeletons = SkeletonIndices(source.skeletons);
  ordered_json array = ordered_json::array();
  for (size_t i = 0; i < source.models.size(); ++i) {
    const ModelInfo& about = source.models[i];
    const std::string name = absl::StrCat(about.name, "@", about.version);
    ordered_json model = {{"name", name}};
    AddText("weights_sha256", about.weights_sha256, &model);
    AddText("terms", about.terms, &model);
    model["free_for_all_uses"] = about.free_for_all_uses;
    AddText("description", about.description, &model);
    model["interaction_classes"] = about.interaction_classes;
    model["skeleton"] = skeletons[i];
    if (about.frame_rate_hz > 0) model["frame_rate_hz"] = about.frame_rate_hz;
    model["samples"] = about.samples;
    const auto made_by = counts.made_by.find(name);
    if (made_by != counts.made_by.end()) AddMadeBy(made_by->second, &model);
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

class IndexWriter {
 public:
  explicit IndexWriter(const JobFolder& folder)
      : files_(folder.temporary(), folder.out()),
        rejected_(files_, "rejected.jsonl"),
        failed_(files_, "failed.jsonl"),
        done_(files_, "index.jsonl") {}

  absl::Status Add(const std::string& text) {
    const absl::StatusOr<v1::IndexEntry> record = ParseRecord(text);
    if (!record.ok()) return record.status();
    if (record->state() == kDone) {
      CountDone(*record);
      return done_.Append(text);
    }
    if (record->state() == kRejected) {
      ++counts_.rejected;
      return rejected_.Append(text);
    }
    if (counts_.failed++ == 0) counts_.first_failure = record->error().message();
    failed_leaders_.insert(record->leader());
    return failed_.Append(text);
  }

  absl::StatusOr<SetCounts> Finish(const SetSource& source, int64_t planned) {
    absl::Status status = rejected_.Close();
    status.Update(failed_.Close());
    status.Update(done_.Close());
    counts_.failed_leaders = static_cast<int64_t>(failed_leaders_.size());
    // Last: it describes the others.
    if (status.ok()) status = files_.Add("dataset.json", DatasetJson(source, counts_, planned));
    if (status.ok()) status = files_.Commit();
    if (!status.ok()) return status;
    return std::move(counts_);
  }

 private:
  // Lines of a file that may be larger than memory.
  class Lines {
   public:
    Lines(FileGroup& files, const char* name)
        : path_(files.Begin(name)), out_(path_, std::ios::binary) {}
    absl::Status Append(const std::string& line) {
      out_ << line << '\n';
      return out_.good() ? absl::OkStatus() : CannotWrite(path_, errno);
    }
    absl::Status Close() {
      out_.close();
      return out_.good() ? absl::OkStatus() : CannotWrite(path_, errno);
    }

   private:
    std::string path_;
    std::ofstream out_;
  };

  void CountDone(const v1::IndexEntry& record) {
    ++counts_.done;
    counts_.frames += record.frames();
    ++counts_.items_by_rate[record.frame_rate_hz()];
    if (const std::optional<MadeBy> how = MadeByOf(record)) {
      counts_.made_by.try_emplace(record.model(), *how);
    }
  }

  FileGroup files_;
  Lines rejected_, failed_, done_;
  std::set<std::string> failed_leaders_;
  SetCounts counts_;
};

}  // namespace

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

std::string DatasetJson(const SetSource& source, const SetCounts& counts, int64_t planned) {
  ordered_json dataset = {{"format", kFormat},
                          {"format_version", kFormatVersion},
                          {"recipe_sha256", source.recipe.digest},
                          {"items",
                           {{"done", counts.done},
                            {"rejected", counts.rejected},
                            {"failed", counts.failed},
                            {"missing", planned - counts.done - counts.rejected - counts.failed}}},
                          {"frames", counts.frames}};
  const v1::Output& output = source.recipe.output;
  if (output.has_frame_rate_hz()) {
    dataset["frame_rate_hz"] = output.frame_rate_hz();
  } else if (counts.items_by_rate.size() == 1) {
    dataset["frame_rate_hz"] = counts.items_by_rate.begin()->first;
  }
  dataset["frame_rates"] = ordered_json::array();
  for (const auto& [rate_hz, items] : counts.items_by_rate) {
    dataset["frame_rates"].push_back({{"frame_rate_hz", rate_hz}, {"items", items}});
  }
  dataset["skeletons"] = SkeletonsJson(source.skeletons);
  dataset["models"] = ModelsJson(source, counts);
  dataset["interaction_classes"] = AllClasses(source.models);
  dataset["files"] = ordered_json::array();
  for (const int format : output.formats()) {
    dataset["files"].push_back(FilesJson(static_cast<v1::Format>(format)));
  }
  return dataset.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

absl::StatusOr<SetCounts> WriteIndex(const JournalReader& journal, const SetSource& source,
                                     int64_t planned, const JobFolder& folder) {
  IndexWriter writer(folder);
  absl::Status status =
      journal.ForEach([&writer](int64_t, const std::string& text) { return writer.Add(text); });
  if (!status.ok()) return status;
  return writer.Finish(source, planned);
}

}  // namespace duet::client::batch
