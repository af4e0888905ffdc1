#include "tests/fuzz/batch_targets.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/batch/index.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leaders.h"
#include "client/batch/recipe.h"
#include "model/base/sha256.h"
#include "tests/fuzz/promises.h"
#include "tests/support/temporary_folder.h"

namespace duet::fuzz {
namespace {

namespace fs = std::filesystem;
using client::batch::JournalReader;

constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;
constexpr auto kDataLoss = absl::StatusCode::kDataLoss;
constexpr auto kFailedPrecondition = absl::StatusCode::kFailedPrecondition;

// One folder for all inputs of a process: files are replaced, not removed.
const test::TemporaryFolder& Folder() {
  static const test::TemporaryFolder kFolder;
  return kFolder;
}

Broken Recipe(absl::string_view input, bool json) {
  const absl::StatusOr<client::batch::Recipe> recipe = client::batch::ParseRecipe(input, json);
  if (!recipe.ok()) return CheckRefusal(recipe.status(), {kInvalidArgument});
  return recipe->models.empty() || recipe->digest.empty() ? "a recipe has no model or no digest"
                                                          : "";
}

// What the journal's writer would have put before each line.
std::string Digested(absl::string_view lines) {
  std::string journal;
  for (const absl::string_view line : absl::StrSplit(lines, '\n', absl::SkipEmpty())) {
    absl::StrAppend(&journal, base::Sha256Hex(Std(line)).substr(0, 8), " ", line, "\n");
  }
  return journal;
}

}  // namespace

Broken RecipeText(absl::string_view input) { return Recipe(input, /*json=*/false); }

Broken RecipeJson(absl::string_view input) { return Recipe(input, /*json=*/true); }

Broken BatchManifest(absl::string_view input) {
  const auto manifest = client::batch::ReadManifest(
      std::make_unique<std::istringstream>(std::string(input)), "folder", "input");
  while (true) {
    const absl::StatusOr<std::optional<client::batch::LeaderEntry>> entry = manifest->Next();
    if (!entry.ok()) return CheckRefusal(entry.status());
    if (!entry->has_value()) return "";
    if ((*entry)->key.empty() || (*entry)->given.empty()) return "a leader has no key or no file";
    if (fs::path((*entry)->key).lexically_normal().begin()->string() == "..") {
      return "a key leads out of the data set";
    }
  }
}

Broken BatchJournal(absl::string_view input) {
  const fs::path path = Folder() / "journal";
  test::WriteTestFile(path, Std(Digested(input)));
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(path);
  if (!journal.ok()) return CheckRefusal(journal.status(), {kDataLoss});
  int64_t visited = 0;
  const absl::Status each = journal->ForEach([&visited](int64_t, const std::string&) {
    ++visited;
    return absl::OkStatus();
  });
  if (!each.ok() || visited != journal->count()) return "a journal's records are not all there";
  fs::create_directories(Folder() / "set/.duet-batch/tmp");
  const client::batch::Recipe recipe;
  const absl::StatusOr<client::batch::SetCounts> counts =
      WriteIndex(*journal, client::batch::SetSource{recipe, {}, {}}, 0,
                 client::batch::JobFolder(Folder() / "set"));
  if (!counts.ok()) return CheckRefusal(counts.status(), {kDataLoss});
  return counts->done + counts->rejected + counts->failed == visited ? "" : "records are lost";
}

Broken BatchJob(absl::string_view input) {
  fs::create_directory(Folder() / ".duet-batch");
  test::WriteTestFile(Folder() / ".duet-batch/job.json", Std(input));
  return CheckRefusal(client::batch::ReadJob(Folder().path()).status(), {kFailedPrecondition});
}

}  // namespace duet::fuzz
