#include "client/batch/dataset_card.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/batch/capture_layout.h"
#include "client/batch/item_table.h"
#include "client/batch/split.h"
#include "client/batch/text_values.h"
#include "model/base/file.h"

namespace duet::client::batch {
namespace {

constexpr char kOwnLine[] =
    "<!-- duet batch replaces this file on every run. To keep changes, remove this line. -->";
constexpr size_t kMaxCardBytes = size_t{16} << 20;

// A text as a YAML scalar: JSON strings are YAML.
std::string Yaml(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// A text of a model on one line of Markdown, without markup.
std::string Plain(const std::string& text) {
  return absl::StrReplaceAll(text, {{"\r", " "}, {"\n", " "}, {"<", "&lt;"}});
}

std::string ModelNames(const JobIdentity& identity) {
  std::vector<std::string> names;
  for (const ModelChoice& model : identity.models) names.push_back(ModelText(model));
  return absl::StrJoin(names, ", ");
}

bool AllFree(const SetDescription& description) {
  return !description.models.empty() &&
         std::all_of(
             description.models.begin(), description.models.end(),
             [](const DescribedModel& model) { return model.free_for_all_uses.value_or(false); });
}

const char* SizeCategory(int64_t items) {
  if (items < 1'000) return "n<1K";
  if (items < 10'000) return "1K<n<10K";
  if (items < 100'000) return "10K<n<100K";
  if (items < 1'000'000) return "100K<n<1M";
  return items < 10'000'000 ? "1M<n<10M" : "10M<n<100M";
}

// Splits without items have no line, because loaders reject empty ones.
std::string Configs(const JobIdentity& identity, const DoneItems& done) {
  std::string files;
  for (const std::string& split : SplitNames(identity.description.splits)) {
    if (done.items_of(split) == 0) continue;
    absl::StrAppend(&files, "  - split: ", split, "\n    path: ", TablePath(split), "\n");
  }
  if (files.empty()) return "";
  return absl::StrCat("configs:\n- config_name: default\n  data_files:\n", files);
}

// The types of the columns, which a loader would otherwise guess from the first rows.
std::string Features(const SetDescription& description) {
  std::string features = "dataset_info:\n  features:\n";
  for (const TableColumn& column : TableColumns(description)) {
    absl::StrAppend(&features, "  - name: ", Yaml(column.name), "\n    dtype: ", column.type, "\n");
  }
  return features;
}

std::string FrontMatter(const JobIdentity& identity, const SetCounts& counts,
                        const DoneItems& done) {
  return absl::StrCat("---\npretty_name: ", Yaml("Reactions by " + ModelNames(identity)),
                      "\nlicense: other\nlicense_name: ",
                      AllFree(identity.description) ? "free-for-all-uses" : "terms-of-the-models",
                      "\ntags:\n- motion\n- human-motion\n- two-person-interaction\n- synthetic\n",
                      "size_categories:\n- ", SizeCategory(counts.done), "\n",
                      Configs(identity, done), Features(identity.description), "---\n");
}

std::string Terms(const JobIdentity& identity) {
  std::string text = "## Terms\n\nThe followers come from these models:\n\n";
  const std::vector<DescribedModel>& described = identity.description.models;
  for (size_t i = 0; i < identity.models.size(); ++i) {
    const DescribedModel about = i < described.size() ? described[i] : DescribedModel();
    absl::StrAppend(&text, "- `", ModelText(identity.models[i]), "`: ",
                    about.free_for_all_uses.value_or(false) ? "**free for all uses.** "
                                                            : "**not free for all uses.** ",
                    about.terms.empty() ? "The model states no terms." : Plain(about.terms), "\n");
  }
  absl::StrAppend(&text,
                  "\nEvery item also contains the motion of its leader. The terms of the leaders' "
                  "files apply to it; Duet does not\nknow them. State them here before you pass "
                  "the set on.\n");
  return text;
}

std::string SplitTable(const JobIdentity& identity, const DoneItems& done) {
  std::string text = "## Splits\n\n| split | items | table | shards |\n|---|---|---|---|\n";
  for (const std::string& split : SplitNames(identity.description.splits)) {
    const std::vector<std::string>& shards = done.shards_of(split);
    absl::StrAppend(&text, "| ", split, " | ", done.items_of(split), " | [", TablePath(split), "](",
                    TablePath(split), ") | ",
                    shards.empty() ? "none: files in folders" : absl::StrCat(shards.size()),
                    " |\n");
  }
  absl::StrAppend(&text,
                  "\nAll items of a leader's file are in one split. The digest of the file decides "
                  "which one.\n");
  return text;
}

bool HasArrays(const SetDescription& description) {
  return std::count(description.formats.begin(), description.formats.end(), Format::kNpy) > 0;
}

// The first split with items; empty if there is none.
std::string FirstSplit(const JobIdentity& identity, const DoneItems& done) {
  for (const std::string& split : SplitNames(identity.description.splits)) {
    if (done.items_of(split) > 0) return split;
  }
  return "";
}

std::string Reading(const JobIdentity& identity, const DoneItems& done) {
  std::string text = absl::StrCat(
      "## Reading the set\n\nOne row of a table is one item: a leader and the follower that reacts "
      "to it. `label_CLASS` is the weight that was\nrequested for a class, `path` is the motion "
      "file");
  const bool packed = !done.shards().empty();
  absl::StrAppend(&text, packed ? " in `shard`, which begins at byte `offset`" : "",
                  ". `dataset.json` has the joints, units and rates.\n");
  const std::string split = FirstSplit(identity, done);
  if (!HasArrays(identity.description) || split.empty()) return text;
  absl::StrAppend(&text, "\n```python\nimport numpy, pandas\n\nitems = pandas.read_csv(\"",
                  TablePath(split), "\")\nitem = items.iloc[0]\n",
                  packed ? "with open(item.shard, \"rb\") as file:\n    file.seek(item.offset)\n"
                           "    leader, follower = numpy.load(file)"
                         : "leader, follower = numpy.load(item.path)",
                  "        # float32 [frames, joints, 3], metres, y up\n```\n");
  return text;
}

std::string Origin(const JobIdentity& identity, const SetCounts& counts) {
  std::string text = "## How it was made\n\nBy `duet batch`, with these models:\n\n";
  const std::vector<DescribedModel>& described = identity.description.models;
  for (size_t i = 0; i < identity.models.size(); ++i) {
    const DescribedModel about = i < described.size() ? described[i] : DescribedModel();
    absl::StrAppend(&text, "- `", ModelText(identity.models[i]), "`",
                    about.description.empty() ? "" : ": ", Plain(about.description),
                    about.weights_sha256.empty() ? "" : "; SHA-256 of the weights: ",
                    about.weights_sha256, "\n");
  }
  absl::StrAppend(&text, "\nRecipe (SHA-256): ", identity.recipe_digest,
                  ". The recipe's filter rejected ", counts.rejected, " items, and ", counts.failed,
                  " failed (`rejected.tsv`, `failed.tsv`).\nThe motions are synthetic: they show "
                  "what the models produce, not what people did.\n");
  return text;
}

}  // namespace

std::string DatasetCard(const JobIdentity& identity, const SetCounts& counts,
                        const DoneItems& done) {
  return absl::StrCat(FrontMatter(identity, counts, done), "\n", kOwnLine, "\n\n# Reactions by ",
                      ModelNames(identity), "\n\n", counts.done, " items with ", done.frames(),
                      " frames: motions of two people, of whom the second (the follower) was "
                      "synthesised in\nreaction to the first (the leader).\n\n",
                      Terms(identity), "\n", SplitTable(identity, done), "\n",
                      Reading(identity, done), "\n", Origin(identity, counts));
}

bool HasForeignCard(const std::filesystem::path& out) {
  std::error_code error;
  if (!std::filesystem::exists(out / kCardFile, error)) return false;
  const absl::StatusOr<std::string> text = base::ReadFile(out / kCardFile, kMaxCardBytes, "a card");
  return !text.ok() || !absl::StrContains(*text, kOwnLine);
}

}  // namespace duet::client::batch
