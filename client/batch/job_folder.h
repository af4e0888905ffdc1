#ifndef DUET_CLIENT_BATCH_JOB_FOLDER_H_
#define DUET_CLIENT_BATCH_JOB_FOLDER_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/batch/durable_file.h"
#include "client/batch/recipe.h"
#include "client/batch/shard.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// What a data set was begun with; every run that adds to it must have the same.
struct JobIdentity {
  std::string recipe_digest;
  Shard shard;
  Layout layout = Layout::kMirror;
  Packing packing = Packing::kNone;
  uint64_t shard_bytes = 0;
  std::vector<ModelChoice> models;          // names and versions; empty before a job has begun
  std::vector<motion::Skeleton> skeletons;  // theirs
};

// A data set's folder, held by one process.
//
//   <out>/                     the data set: files, index.tsv, index.jsonl, rejected.tsv,
//   summary.json <out>/errors/              a file for each item that failed <out>/.duet-batch/
//   job.json, journal, lock; temporary files; items that wait to be packed
class JobFolder {
 public:
  explicit JobFolder(std::filesystem::path out) : out_(std::move(out)) {}

  // Makes and locks the folder, removes temporary files, and reads what the job was begun with into
  // `begun`; its models are empty where there is none. FAILED_PRECONDITION where that is not what
  // is `wanted` now, ABORTED where the folder is locked or cannot be written.
  absl::Status Open(const JobIdentity& wanted, JobIdentity* begun);
  // Settles what a new job is begun with.
  absl::Status Begin(const JobIdentity& identity) const;

  const std::filesystem::path& out() const { return out_; }
  std::filesystem::path journal() const { return state() / "journal"; }
  // Where they lie in a single file until then; see item_files.h.
  std::filesystem::path spool() const { return state() / "spool"; }
  std::filesystem::path temporary() const { return state() / "tmp"; }
  std::filesystem::path errors() const { return out_ / "errors"; }
  // Where items' files lie until they are packed, or for good.
  std::filesystem::path items(Packing packing) const {
    return packing == Packing::kNone ? out_ : state() / "items";
  }

 private:
  std::filesystem::path state() const { return out_ / ".duet-batch"; }

  std::filesystem::path out_;
  FolderLock lock_;
};

// What <out>/.duet-batch/job.json says. NOT_FOUND where `out` is no data set of `duet batch`.
absl::StatusOr<JobIdentity> ReadJobIdentity(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOB_FOLDER_H_
