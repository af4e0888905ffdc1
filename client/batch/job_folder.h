#ifndef DUET_CLIENT_BATCH_JOB_FOLDER_H_
#define DUET_CLIENT_BATCH_JOB_FOLDER_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/batch/durable_file.h"
#include "client/batch/recipe.h"
#include "client/batch/set_description.h"
#include "client/batch/shard.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// What a data set was begun with; every run that adds to it must have the same.
struct JobIdentity {
  std::string recipe_digest;
  std::string recipe_json;  // Recipe::json; empty of a set begun before it was kept
  Shard shard;
  Layout layout = Layout::kMirror;
  Packing packing = Packing::kNone;
  uint64_t shard_bytes = 0;
  std::vector<ModelChoice> models;          // names and versions; empty before a job has begun
  std::vector<motion::Skeleton> skeletons;  // theirs
  SetDescription description;
};

// A data set's folder, held by one process.
//
//   <out>/                     the data set: files, dataset.json, index.tsv, index.jsonl,
//                              rejected.tsv, failed.tsv, summary.json
//   <out>/.duet-batch/         job.json, recipe.json, command.json, journal, shards, damage, lock;
//                              temporary files; items that wait to be packed
class JobFolder {
 public:
  explicit JobFolder(std::filesystem::path out) : out_(std::move(out)) {}

  // Makes and locks the folder and removes temporary files of runs that were killed. ABORTED where
  // the folder is locked or cannot be written.
  absl::Status Take();
  // The same, and reads what the job was begun with into `begun`; its models are empty where there
  // is none. Also FAILED_PRECONDITION, naming what differs, where that is not what is `wanted` now.
  absl::Status Open(const JobIdentity& wanted, JobIdentity* begun);
  // The same for a run that may add items: a job of another recipe of which no item was answered is
  // removed, as if it had never begun.
  absl::Status OpenForRun(const JobIdentity& wanted, JobIdentity* begun);
  // Settles what a new job is begun with.
  absl::Status Begin(const JobIdentity& identity) const;

  const std::filesystem::path& out() const { return out_; }
  std::filesystem::path journal() const { return state() / "journal"; }
  // Where they lie in a single file until then; see item_files.h.
  std::filesystem::path spool() const { return state() / "spool"; }
  // Which items each shard holds; see shard_list.h.
  std::filesystem::path shards() const { return state() / "shards"; }
  // What was found damaged and is still to be repaired; see damage.h.
  std::filesystem::path damage() const { return state() / "damage"; }
  // The command that the last run was started with; see client/cli/batch_repair.h.
  std::filesystem::path command() const { return state() / "command.json"; }
  std::filesystem::path temporary() const { return state() / "tmp"; }
  // Where items' files lie until they are packed, or for good.
  std::filesystem::path items(Packing packing) const {
    return packing == Packing::kNone ? out_ : state() / "items";
  }

 private:
  std::filesystem::path state() const { return out_ / ".duet-batch"; }
  bool HasAnswers() const;
  absl::Status Discard() const;

  std::filesystem::path out_;
  FolderLock lock_;
};

// What <out>/.duet-batch/job.json says. NOT_FOUND where `out` is no data set of `duet batch`.
absl::StatusOr<JobIdentity> ReadJobIdentity(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOB_FOLDER_H_
