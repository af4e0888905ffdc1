#include "client/batch/index.h"

#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/batch/capture_layout.h"
#include "client/batch/dataset_card.h"
#include "client/batch/dataset_json.h"
#include "client/batch/failures.h"
#include "client/batch/item_table.h"
#include "client/batch/parse_record.h"
#include "client/batch/record.h"
#include "client/batch/text_values.h"
#include "model/base/file.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr size_t kCausesKept = 20;
constexpr size_t kMaxSummaryBytes = size_t{1} << 20;

constexpr const char* kFields[] = {
    "item",  "id",   "name",    "leader",     "leader_sha256", "side",   "reaction",     "labels",
    "model", "seed", "variety", "candidates", "request_id",    "frames", "frame_rate_hz"};
// A field as a TSV cell, without tabs and line ends; empty if the field is missing.
std::string Cell(const ordered_json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) return "";
  const std::string text = found->is_string() ? found->get<std::string>() : Line(*found);
  return absl::StrReplaceAll(text, {{"\t", " "}, {"\n", " "}, {"\r", " "}});
}

// "kick=1,hug=0.5", or the keyframes as JSON.
std::string LabelsCell(const ordered_json& record) {
  if (!record.contains("labels")) return Cell(record, "keyframes");
  std::vector<std::string> labels;
  for (const auto& [name, weight] : record["labels"].items()) {
    labels.push_back(absl::StrCat(name, "=", weight.dump()));
  }
  return absl::StrReplaceAll(absl::StrJoin(labels, ","), {{"\t", " "}, {"\n", " "}});
}

std::vector<std::string> CommonCells(const ordered_json& record) {
  std::vector<std::string> cells;
  for (const char* field : kFields) {
    cells.push_back(absl::string_view(field) == "labels" ? LabelsCell(record)
                                                         : Cell(record, field));
  }
  for (const char* figure : kQualityFields) cells.push_back(Cell(record["quality"], figure));
  cells.push_back(Cell(record, "unfamiliarity"));
  return cells;
}

std::vector<std::string> CommonHeader() {
  std::vector<std::string> header(std::begin(kFields), std::end(kFields));
  header.insert(header.end(), std::begin(kQualityFields), std::end(kQualityFields));
  header.emplace_back("unfamiliarity");
  return header;
}

std::string Row(const std::vector<std::string>& cells) { return absl::StrJoin(cells, "\t") + "\n"; }

std::vector<std::string> FileCells(const ordered_json& record, const char* field) {
  std::vector<std::string> cells;
  for (const ordered_json& file : record["files"]) cells.push_back(Cell(file, field));
  return cells;
}

uint64_t BytesOf(const ordered_json& record) {
  uint64_t bytes = 0;
  for (const ordered_json& file : record["files"]) bytes += file["bytes"].get<uint64_t>();
  return bytes;
}

// The files with one line for each item.
class IndexWriter {
 public:
  IndexWriter(const JobIdentity& identity, const ShardList& shards)
      : captures_(CapturesOf(identity.layout) != nullptr),
        identity_(identity),
        shards_(shards),
        tables_(identity, shards) {}

  absl::Status Open(SetFiles* files) {
    absl::Status status = Begin("index.jsonl", files, &json_);
    if (status.ok()) status = Begin("index.tsv", files, &tsv_);
    if (status.ok()) status = Begin("rejected.tsv", files, &rejected_);
    if (status.ok()) status = failed_.Open(files);
    if (status.ok()) status = tables_.Open(files);
    return status.ok() ? WriteHeaders() : status;
  }

  absl::Status Add(const JournalEntry& entry) {
    absl::StatusOr<ordered_json> parsed = ParseRecord(entry.record);
    if (!parsed.ok()) return parsed.status();
    ordered_json& record = *parsed;
    if (record["state"] == kFailed) {
      ++counts_.failed;
      return failed_.Add(record);
    }
    return record["state"] == kDone ? AddDone(entry.item, &record) : AddRejected(record);
  }

  absl::Status Finish() {
    absl::Status status = rejected_->Finish();
    status.Update(failed_.Finish());
    counts_.failures = failed_.causes().Largest(kCausesKept);
    counts_.failed_leaders = failed_.leaders();
    status.Update(tables_.Finish());
    status.Update(tsv_->Finish());
    status.Update(json_->Finish());
    return status;
  }

  const SetCounts& counts() const { return counts_; }
  const DoneItems& done() const { return done_; }

 private:
  static absl::Status Begin(const char* name, SetFiles* files, std::unique_ptr<SetFile>* file) {
    absl::StatusOr<std::unique_ptr<SetFile>> begun = files->Begin(name);
    if (begun.ok()) *file = *std::move(begun);
    return begun.status();
  }

  absl::Status WriteHeaders() {
    std::vector<std::string> header = CommonHeader();
    std::vector<std::string> rejected = header;
    rejected.insert(rejected.end(), {"answers", "reasons", "extra"});
    absl::Status status = rejected_->Append(Row(rejected));
    if (identity_.packing != Packing::kNone) header.emplace_back("shard");
    // The columns that readers of captures need.
    if (captures_) header.insert(header.end(), {"path", "leader_side"});
    header.insert(header.end(), {"files", "sha256", "extra"});
    status.Update(tsv_->Append(Row(header)));
    return status;
  }

  absl::Status AddDone(int64_t item, ordered_json* record) {
    ++counts_.done;
    counts_.bytes += BytesOf(*record);
    absl::Status status = tables_.Add(item, *record);
    const std::string line = IndexLine(item, identity_, shards_, record);
    std::vector<std::string> cells = CommonCells(*record);
    if (identity_.packing != Packing::kNone) cells.push_back(Cell(*record, "shard"));
    done_.Add(*record);
    if (captures_) {
      cells.push_back(FileCells(*record, "path").front());
      cells.push_back(Cell(*record, "side"));
    }
    cells.push_back(absl::StrJoin(FileCells(*record, "path"), ","));
    cells.push_back(absl::StrJoin(FileCells(*record, "sha256"), ","));
    cells.push_back(Cell(*record, "extra"));
    status.Update(json_->Append(line + "\n"));
    status.Update(tsv_->Append(Row(cells)));
    return status;
  }

  absl::Status AddRejected(const ordered_json& record) {
    ++counts_.rejected;
    std::vector<std::string> cells = CommonCells(record);
    cells.push_back(Cell(record, "answers"));
    std::vector<std::string> reasons;
    for (const ordered_json& reason : record["reasons"]) reasons.push_back(reason);
    cells.push_back(absl::StrJoin(reasons, "; "));
    cells.push_back(Cell(record, "extra"));
    return rejected_->Append(Row(cells));
  }

  bool captures_;  // in a layout of captures
  const JobIdentity& identity_;
  const ShardList& shards_;
  std::unique_ptr<SetFile> json_, tsv_, rejected_;
  ItemTables tables_;
  FailureTable failed_;
  SetCounts counts_;
  DoneItems done_;
};

std::string SummaryJson(const JobIdentity& identity, const SetCounts& counts,
                        const PlannedItems& planned) {
  ordered_json models = ordered_json::array();
  for (const ModelChoice& model : identity.models) {
    models.push_back(ModelText(model));
  }
  ordered_json summary = {
      {"planned", planned.count},
      {"whole_plan", planned.whole},
      {"done", counts.done},
      {"rejected", counts.rejected},
      {"failed", counts.failed},
      {"missing", planned.count - counts.done - counts.rejected - counts.failed},
      {"bytes", counts.bytes},
      {"models", models},
      {"recipe_sha256", identity.recipe_digest},
      {"shard", absl::StrCat(identity.shard.index, "/", identity.shard.count)}};
  if (!counts.failures.empty()) summary["failures"] = ToJson(counts.failures);
  return summary.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string IndexLine(int64_t item, const JobIdentity& identity, const ShardList& shards,
                      ordered_json* record) {
  const std::string split = SplitOfRecord(identity.description.splits, *record);
  const size_t shard = shards.ShardOf(item);
  if (shard != ShardList::kNone) (*record)["shard"] = shards.NameOf(shard, identity.packing);
  if (!split.empty()) (*record)["split"] = split;
  return Line(*record);
}

absl::StatusOr<SetCounts> WriteIndex(const JournalReader& journal, const JobIdentity& identity,
                                     const ShardList& shards, const PlannedItems& planned,
                                     SetFiles* files) {
  IndexWriter writer(identity, shards);
  absl::Status status = writer.Open(files);
  if (status.ok()) {
    status = journal.ForEach([&writer](const JournalEntry& entry) { return writer.Add(entry); });
  }
  if (status.ok()) status = writer.Finish();
  if (status.ok() && !HasForeignCard(files->out())) {
    status = files->Put(kCardFile, DatasetCard(identity, writer.counts(), writer.done()));
  }
  if (status.ok()) {
    status = files->Put("dataset.json", DatasetJson(identity, writer.counts(), planned.count,
                                                    writer.done(), !shards.empty()));
  }
  // Last: its presence means that the others are there.
  if (status.ok()) {
    status = files->Put("summary.json", SummaryJson(identity, writer.counts(), planned));
  }
  if (!status.ok()) return status;
  return writer.counts();
}

absl::StatusOr<PlannedItems> ReadPlanned(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "summary.json";
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxSummaryBytes, "a summary");
  if (!text.ok()) return text.status();
  const auto summary = nlohmann::json::parse(*text, nullptr, false);
  const auto is_count = [&summary](const char* field) {
    return summary.contains(field) && summary[field].is_number_integer();
  };
  if (!summary.is_object() || !is_count("planned") || !is_count("missing") ||
      !summary.contains("whole_plan") || !summary["whole_plan"].is_boolean()) {
    return absl::DataLossError(absl::StrCat(file.string(), ": is not a summary of duet batch"));
  }
  return PlannedItems{summary["planned"], summary["whole_plan"], summary["missing"]};
}

}  // namespace duet::client::batch
