#include "client/batch/index.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/batch/capture_layout.h"
#include "client/batch/dataset_json.h"
#include "client/batch/durable_file.h"
#include "client/batch/record.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr size_t kCausesKept = 20;

constexpr const char* kFields[] = {
    "item",  "id",   "name",    "leader",     "leader_sha256", "side",   "reaction",     "labels",
    "model", "seed", "variety", "candidates", "request_id",    "frames", "frame_rate_hz"};

std::string Plain(std::string text) {
  return absl::StrReplaceAll(text, {{"\t", " "}, {"\n", " "}, {"\r", " "}});
}

// A field as a TSV cell, without tabs and line ends; empty if the field is missing.
std::string Cell(const ordered_json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) return "";
  return Plain(found->is_string() ? found->get<std::string>() : Line(*found));
}

// "kick=1,hug=0.5", or the keyframes as JSON.
std::string LabelsCell(const ordered_json& record) {
  if (!record.contains("labels")) return Cell(record, "keyframes");
  std::vector<std::string> labels;
  for (const auto& [name, weight] : record["labels"].items()) {
    labels.push_back(absl::StrCat(name, "=", weight.dump()));
  }
  return Plain(absl::StrJoin(labels, ","));
}

// A field of every file, separated by commas.
std::string FilesCell(const ordered_json& record, const char* field) {
  std::vector<std::string> cells;
  for (const ordered_json& file : record["files"]) cells.push_back(Cell(file, field));
  return absl::StrJoin(cells, ",");
}

std::string ReasonsCell(const ordered_json& record) {
  std::vector<std::string> reasons;
  for (const ordered_json& reason : record["reasons"]) reasons.push_back(reason);
  return Plain(absl::StrJoin(reasons, "; "));
}

// A table of items: the columns of every answer, and then its own.
class Table {
 public:
  Table(const JobFolder& folder, const std::string& name, std::vector<std::string> own_columns)
      : file_(folder.temporary() / name),
        path_(folder.out() / name),
        own_columns_(std::move(own_columns)) {}

  absl::Status Open() {
    std::vector<std::string> header(std::begin(kFields), std::end(kFields));
    header.insert(header.end(), std::begin(kQualityFields), std::end(kQualityFields));
    header.emplace_back("unfamiliarity");
    absl::Status status = file_.Open();
    return status.ok() ? Append(header, own_columns_) : status;
  }
  absl::Status Add(const ordered_json& record, const std::vector<std::string>& own_cells) {
    std::vector<std::string> cells;
    for (const char* field : kFields) {
      cells.push_back(absl::string_view(field) == "labels" ? LabelsCell(record)
                                                           : Cell(record, field));
    }
    for (const char* figure : kQualityFields) cells.push_back(Cell(record["quality"], figure));
    cells.push_back(Cell(record, "unfamiliarity"));
    return Append(cells, own_cells);
  }
  absl::Status Finish() { return file_.Finish(path_); }

 private:
  absl::Status Append(const std::vector<std::string>& common, const std::vector<std::string>& own) {
    return file_.Append(
        absl::StrCat(absl::StrJoin(common, "\t"), "\t", absl::StrJoin(own, "\t"), "\n"));
  }

  DurableFile file_;
  const std::filesystem::path path_;
  const std::vector<std::string> own_columns_;
};

// The files with one line for each item.
class IndexWriter {
 public:
  IndexWriter(const JobFolder& folder, bool captures)
      : captures_(captures),
        lines_(folder.temporary() / "index.jsonl"),
        lines_path_(folder.out() / "index.jsonl"),
        done_table_(folder, "index.tsv", DoneColumns(captures)),
        rejected_table_(folder, "rejected.tsv", {"answers", "reasons", "extra"}),
        failed_table_(folder) {}

  absl::Status Open() {
    absl::Status status = lines_.Open();
    status.Update(done_table_.Open());
    status.Update(rejected_table_.Open());
    status.Update(failed_table_.Open());
    return status;
  }

  absl::Status Add(const JournalEntry& entry) {
    const absl::StatusOr<ordered_json> record = ParseRecord(entry.record);
    if (!record.ok()) return record.status();
    if ((*record)["state"] == kDone) return AddDone(*record);
    if ((*record)["state"] == kFailed) {
      ++counts_.failed;
      return failed_table_.Add(*record);
    }
    ++counts_.rejected;
    return rejected_table_.Add(
        *record, {Cell(*record, "answers"), ReasonsCell(*record), Cell(*record, "extra")});
  }

  absl::Status Finish() {
    absl::Status status = rejected_table_.Finish();
    status.Update(failed_table_.Finish());
    counts_.failures = failed_table_.causes().Largest(kCausesKept);
    counts_.failed_leaders = failed_table_.leaders();
    status.Update(done_table_.Finish());
    status.Update(lines_.Finish(lines_path_));
    return status;
  }

  const SetCounts& counts() const { return counts_; }
  const DoneItems& done() const { return done_; }

 private:
  // The columns that readers of captures need come first.
  static std::vector<std::string> DoneColumns(bool captures) {
    std::vector<std::string> columns = {"files", "sha256", "extra"};
    if (captures) columns.insert(columns.begin(), {"path", "leader_side"});
    return columns;
  }

  absl::Status AddDone(const ordered_json& record) {
    ++counts_.done;
    for (const ordered_json& file : record["files"]) counts_.bytes += file["bytes"].get<uint64_t>();
    done_.Add(record);
    std::vector<std::string> cells = {FilesCell(record, "path"), FilesCell(record, "sha256"),
                                      Cell(record, "extra")};
    if (captures_) {
      cells.insert(cells.begin(), {Cell(record["files"][0], "path"), Cell(record, "side")});
    }
    absl::Status status = lines_.Append(Line(record) + "\n");
    status.Update(done_table_.Add(record, cells));
    return status;
  }

  const bool captures_;  // in a layout of captures
  DurableFile lines_;
  const std::filesystem::path lines_path_;
  Table done_table_, rejected_table_;
  FailureTable failed_table_;
  SetCounts counts_;
  DoneItems done_;
};

std::string SummaryJson(const SetSource& source, const SetCounts& counts,
                        const PlannedItems& planned) {
  ordered_json models = ordered_json::array();
  for (const ModelInfo& model : source.models) models.push_back(NameOfModel(model));
  const ordered_json summary = {
      {"planned", planned.count},
      {"whole_plan", planned.whole},
      {"done", counts.done},
      {"rejected", counts.rejected},
      {"failed", counts.failed},
      {"missing", planned.count - counts.done - counts.rejected - counts.failed},
      {"bytes", counts.bytes},
      {"models", models},
      {"recipe_sha256", source.recipe.digest},
      {"shard", absl::StrCat(source.shard.index, "/", source.shard.count)}};
  return summary.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

absl::StatusOr<SetCounts> WriteIndex(const JournalReader& journal, const SetSource& source,
                                     const PlannedItems& planned, const JobFolder& folder) {
  IndexWriter writer(folder, CapturesOf(source.recipe.output.layout()) != nullptr);
  absl::Status status = writer.Open();
  if (status.ok()) {
    status = journal.ForEach([&writer](const JournalEntry& entry) { return writer.Add(entry); });
  }
  if (status.ok()) status = writer.Finish();
  if (status.ok()) {
    status = WriteDurably(folder.temporary() / "dataset.json", folder.out() / "dataset.json",
                          DatasetJson(source, writer.counts(), planned.count, writer.done()));
  }
  // Last: its presence means that the others are there.
  if (status.ok()) {
    status = WriteDurably(folder.temporary() / "summary.json", folder.out() / "summary.json",
                          SummaryJson(source, writer.counts(), planned));
  }
  if (!status.ok()) return status;
  return writer.counts();
}

}  // namespace duet::client::batch
