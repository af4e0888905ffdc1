#include "client/batch/item_table.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/batch/record.h"
#include "client/batch/split.h"
#include "client/batch/text_values.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr char kText[] = "string";
constexpr char kWhole[] = "int64";
constexpr char kReal[] = "float64";

// A cell of CSV.
std::string Quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  return absl::StrCat("\"", absl::StrReplaceAll(text, {{"\"", "\"\""}}), "\"");
}

// A field as text; empty if the record does not have it.
std::string Field(const ordered_json& object, const std::string& name) {
  const auto found = object.find(name);
  if (found == object.end() || found->is_null()) return "";
  return found->is_string() ? found->get<std::string>() : Line(*found);
}

// The weight of a class; empty if weights change over time.
std::string LabelCell(const ordered_json& record, const std::string& name) {
  const auto labels = record.find("labels");
  if (labels == record.end()) return record.contains("keyframes") ? "" : "0";
  const auto weight = labels->find(name);
  return weight == labels->end() ? "0" : weight->dump();
}

std::string Paths(const ordered_json& record, Packing packing) {
  std::vector<std::string> paths;
  for (const ordered_json& file : record["files"]) {
    paths.push_back(MemberName(packing, file["path"]));
  }
  return absl::StrJoin(paths, ",");
}

// The file that a row names: the array if there is one, otherwise the first.
size_t MainFile(const ordered_json& record) {
  const ordered_json& files = record["files"];
  for (size_t i = 0; i < files.size(); ++i) {
    if (absl::EndsWith(files[i]["path"].get<std::string>(), ".npy")) return i;
  }
  return 0;
}

}  // namespace

std::vector<TableColumn> TableColumns(const SetDescription& description) {
  std::vector<TableColumn> columns = {{"id", kText},
                                      {"name", kText},
                                      {"split", kText},
                                      {"leader", kText},
                                      {"leader_sha256", kText},
                                      {"side", kText},
                                      {"reaction", kText},
                                      {"interaction_class", kText}};
  for (const std::string& name : AllClasses(description)) {
    columns.push_back({absl::StrCat("label_", name), kReal});
  }
  columns.insert(columns.end(), {{"keyframes", kText},
                                 {"model", kText},
                                 {"free_for_all_uses", "bool"},
                                 {"seed", "uint64"},
                                 {"variety", kReal},
                                 {"candidates", kWhole},
                                 {"frames", kWhole},
                                 {"frame_rate_hz", kReal},
                                 {"skeleton", kWhole}});
  for (const char* figure : kQualityFields) {
    columns.push_back({figure, figure == kRecognisedClass ? kText : kReal});
  }
  columns.insert(columns.end(), {{"unfamiliarity", kReal},
                                 {"shard", kText},
                                 {"path", kText},
                                 {"offset", kWhole},
                                 {"bytes", kWhole},
                                 {"sha256", kText},
                                 {"files", kText},
                                 {"extra", kText}});
  return columns;
}

std::string TablePath(const std::string& split) { return absl::StrCat("items/", split, ".csv"); }

ItemTables::ItemTables(const JobIdentity& identity, const ShardList& shards)
    : identity_(identity),
      shards_(shards),
      classes_(AllClasses(identity.description)),
      offsets_(identity.packing) {
  const std::vector<DescribedModel>& models = identity.description.models;
  for (size_t i = 0; i < models.size() && i < identity.models.size(); ++i) {
    free_[ModelText(identity.models[i])] = models[i].free_for_all_uses.value_or(false);
  }
}

absl::Status ItemTables::Open(SetFiles* files) {
  std::vector<std::string> header;
  for (const TableColumn& column : TableColumns(identity_.description)) {
    header.push_back(Quoted(column.name));
  }
  for (const std::string& split : SplitNames(identity_.description.splits)) {
    absl::StatusOr<std::unique_ptr<SetFile>> table = files->Begin(TablePath(split));
    if (!table.ok()) return table.status();
    absl::Status status = (*table)->Append(absl::StrJoin(header, ",") + "\n");
    if (!status.ok()) return status;
    tables_[split] = *std::move(table);
  }
  return absl::OkStatus();
}

absl::Status ItemTables::Add(int64_t item, const ordered_json& record) {
  const std::string named = SplitOfRecord(identity_.description.splits, record);
  const std::string split = named.empty() ? kTrain : named;
  const size_t file = MainFile(record);
  return tables_[split]->Append(Row(record, split, PlaceOf(item, record, file), file));
}

absl::Status ItemTables::Finish() {
  absl::Status status;
  for (const auto& [split, table] : tables_) status.Update(table->Finish());
  return status;
}

ItemTables::Place ItemTables::PlaceOf(int64_t item, const ordered_json& record, size_t file) {
  const std::string path = record["files"][file]["path"];
  const size_t shard = shards_.ShardOf(item);
  if (shard == ShardList::kNone) return {"", path, 0};
  return {shards_.NameOf(shard, identity_.packing), MemberName(identity_.packing, path),
          offsets_.Next(shard, record, file)};
}

std::string ItemTables::Row(const ordered_json& record, const std::string& split,
                            const Place& place, size_t file) const {
  std::vector<std::string> cells = {Field(record, "id"),
                                    Field(record, "name"),
                                    split,
                                    Field(record, "leader"),
                                    Field(record, "leader_sha256"),
                                    Field(record, "side"),
                                    Field(record, "reaction"),
                                    LargestClass(record)};
  for (const std::string& name : classes_) cells.push_back(LabelCell(record, name));
  cells.push_back(Field(record, "keyframes"));
  cells.push_back(Field(record, "model"));
  const auto free = free_.find(cells.back());
  cells.emplace_back(free != free_.end() && free->second ? "true" : "false");
  for (const char* name : {"seed", "variety", "candidates", "frames", "frame_rate_hz"}) {
    cells.push_back(Field(record, name));
  }
  cells.push_back(absl::StrCat(record.value("skeleton", 0)));
  for (const char* figure : kQualityFields) cells.push_back(Field(record["quality"], figure));
  cells.push_back(Field(record, "unfamiliarity"));
  cells.insert(cells.end(),
               {place.shard, place.path, absl::StrCat(place.offset),
                Field(record["files"][file], "bytes"), Field(record["files"][file], "sha256"),
                Paths(record, place.shard.empty() ? Packing::kNone : identity_.packing),
                Field(record, "extra")});
  for (std::string& cell : cells) cell = Quoted(cell);
  return absl::StrJoin(cells, ",") + "\n";
}

}  // namespace duet::client::batch
