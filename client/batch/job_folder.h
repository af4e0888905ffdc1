#ifndef DUET_CLIENT_BATCH_JOB_FOLDER_H_
#define DUET_CLIENT_BATCH_JOB_FOLDER_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/batch/durable_file.h"
#include "client/batch/recipe.h"
#include "client/batch/set_description.h"
#include "client/batch/shard.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// The properties that a data set was begun with. Every run that adds to it must have the same.
struct JobIdentity {
  std::string recipe_digest;
  std::string recipe_json;  // Recipe::json; empty in sets that were begun before it was stored
  Shard shard;
  Layout layout = Layout::kMirror;
  Packing packing = Packing::kNone;
  uint64_t shard_bytes = 0;
  std::vector<ModelChoice> models;          // names and versions; empty before a job has begun
  std::vector<motion::Skeleton> skeletons;  // of the models
  SetDescription description;
  std::optional<motion::Vec3> up;  // of every leader (SynthesisOptions::up)
  SeedRule seed_rule = SeedRule::kContent;
};

// A data set's folder, held by one process.
//
//   <out>/                     the data set: files, README.md, dataset.json, items/, index.tsv,
//                              index.jsonl, rejected.tsv, failed.tsv, summary.json
//   <out>/.duet-batch/         job.json, recipe.json, command.json, journal, shards, damage, lock;
//                              temporary files; items that wait to be packed
class JobFolder {
 public:
  explicit JobFolder(std::filesystem::path out) : out_(std::move(out)) {}

  // Creates and locks the folder, and removes temporary files of runs that were killed. ABORTED if
  // the folder is locked or cannot be written.
  absl::Status Take();
  // Like Take, and reads the identity of the job into `begun`, with no models if there is no job.
  // FAILED_PRECONDITION, with the differences, if that is not the `wanted` identity.
  absl::Status Open(const JobIdentity& wanted, JobIdentity* begun);
  // Like Open, for a run that may add items: removes a job of another recipe that has no answers
  // yet.
  absl::Status OpenForRun(const JobIdentity& wanted, JobIdentity* begun);
  // Stores the identity of a new job.
  absl::Status Begin(const JobIdentity& identity) const;

  const std::filesystem::path& out() const { return out_; }
  std::filesystem::path journal() const { return state() / "journal"; }
  // Items that wait to be packed; see item_files.h.
  std::filesystem::path spool() const { return state() / "spool"; }
  // Which items each shard holds; see shard_list.h.
  std::filesystem::path shards() const { return state() / "shards"; }
  // Damage that was found and not repaired yet; see damage.h.
  std::filesystem::path damage() const { return state() / "damage"; }
  // The command of the last run; see client/cli/batch_repair.h.
  std::filesystem::path command() const { return state() / "command.json"; }
  std::filesystem::path temporary() const { return state() / "tmp"; }
  // The folder of items' files: temporary if they will be packed.
  std::filesystem::path items(Packing packing) const {
    return packing == Packing::kNone ? out_ : state() / "items";
  }

 private:
  std::filesystem::path state() const { return out_ / ".duet-batch"; }
  // Reads the identity of the job and compares it with the wanted one; see Open.
  absl::Status Compare(const JobIdentity& wanted, JobIdentity* begun) const;
  bool HasAnswers() const;
  absl::Status Discard() const;

  std::filesystem::path out_;
  FolderLock lock_;
};

// Reads <out>/.duet-batch/job.json. NOT_FOUND if `out` is not a data set of `duet batch`.
absl::StatusOr<JobIdentity> ReadJobIdentity(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOB_FOLDER_H_
