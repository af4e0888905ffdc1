#include "client/cli/batch_repair.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <system_error>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/batch/durable_file.h"
#include "client/cli/batch_flags.h"
#include "model/base/file.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxCommandBytes = size_t{4} << 20;

struct KeptCommand {
  std::string folder;
  std::string shard;
  std::vector<std::string> words;
};

absl::Status Unknown(const fs::path& out, absl::string_view why) {
  return absl::FailedPreconditionError(
      absl::StrCat(out.string(), ": ", why,
                   ". Run the duet batch command that made it again, which repairs the damage"));
}

absl::StatusOr<KeptCommand> ReadKept(const fs::path& out) {
  const absl::StatusOr<std::string> text =
      base::ReadFile(batch::JobFolder(out).command(), kMaxCommandBytes, "a command");
  const auto object = nlohmann::json::parse(text.value_or(""), nullptr, false);
  const auto is_text = [](const nlohmann::json& value) { return value.is_string(); };
  if (!object.is_object() || !object.contains("words") || !object["words"].is_array() ||
      !std::all_of(object["words"].begin(), object["words"].end(), is_text) ||
      !object.contains("folder") || !is_text(object["folder"]) || !object.contains("shard") ||
      !is_text(object["shard"])) {
    return Unknown(out, "the command that made it is not recorded");
  }
  return KeptCommand{object["folder"], object["shard"], object["words"]};
}

}  // namespace

absl::Status KeepCommand(const BatchArguments& arguments, const batch::Shard& shard,
                         const batch::JobFolder& folder) {
  std::error_code error;
  const nlohmann::ordered_json command = {{"folder", fs::current_path(error).string()},
                                          {"shard", absl::StrCat(shard.index, "/", shard.count)},
                                          {"words", arguments.words}};
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  return batch::ReplaceDurably(folder.command(), command.dump(2, ' ', false, kReplace) + "\n");
}

absl::StatusOr<BatchArguments> CommandOf(const BatchArguments& verify) {
  const absl::StatusOr<KeptCommand> kept = ReadKept(verify.out);
  if (!kept.ok()) return kept.status();
  absl::StatusOr<BatchArguments> parsed = ParseBatch(kept->words);
  const absl::StatusOr<batch::Shard> shard = batch::ParseShard(kept->shard);
  if (!parsed.ok() || !shard.ok()) {
    return Unknown(verify.out, "the command that made it is not valid");
  }
  if (parsed->manifest == "-") return Unknown(verify.out, "its leaders came from a pipe");
  BatchArguments command = *std::move(parsed);
  const fs::path out = fs::absolute(verify.out / "").lexically_normal().parent_path();
  command.out = shard->count == 1 ? out : out.parent_path();
  command.shard = *shard;
  command.json = verify.json;
  command.quiet = false;
  command.retry_failed = false;
  if (!verify.repairers.empty()) command.servers = verify.repairers;
  return command;
}

absl::Status EnterFolderOf(const fs::path& out) {
  const absl::StatusOr<KeptCommand> kept = ReadKept(out);
  if (!kept.ok()) return kept.status();
  std::error_code error;
  fs::current_path(kept->folder, error);
  if (!error) return absl::OkStatus();
  return Unknown(out, absl::StrCat("was made in ", kept->folder,
                                   ", which cannot be entered: ", error.message()));
}

}  // namespace duet::client::cli
