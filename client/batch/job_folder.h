#ifndef DUET_CLIENT_BATCH_JOB_FOLDER_H_
#define DUET_CLIENT_BATCH_JOB_FOLDER_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/durable_file.h"
#include "client/batch/plan.h"
#include "client/batch/recipe.h"
#include "client/result.h"

namespace duet::client::batch {

// The identity of a job of this recipe, with the models that a server serves; none: not known yet.
v1::Job IdentityOf(const Recipe& recipe, const Shard& shard,
                   const std::vector<ModelInfo>& models = {});

// FAILED_PRECONDITION if the weights of a model are not those that the set was begun with.
absl::Status CheckWeights(const v1::Job& begun, const v1::Job& now);

// A data set's folder, held by one process.
//
//   <out>/                     the data set: files, dataset.json, index.jsonl, rejected.jsonl,
//                              failed.jsonl
//   <out>/.duet-batch/         job.json, journal, lock; temporary files
class JobFolder {
 public:
  explicit JobFolder(std::filesystem::path out) : out_(std::move(out)) {}

  // Creates and locks the folder, removes temporary files of runs that were killed, and reads the
  // identity of the job into `begun`, with no models if there is no job. ABORTED if the folder is
  // locked or cannot be written; FAILED_PRECONDITION, with the differences, if that is not the
  // `wanted` identity.
  absl::Status Open(const v1::Job& wanted, v1::Job* begun);
  // Stores the identity of a new job.
  absl::Status Begin(const v1::Job& identity) const;

  const std::filesystem::path& out() const { return out_; }
  std::filesystem::path journal() const { return state() / "journal"; }
  std::filesystem::path temporary() const { return state() / "tmp"; }

 private:
  std::filesystem::path state() const { return out_ / ".duet-batch"; }

  std::filesystem::path out_;
  FolderLock lock_;
};

// Reads <out>/.duet-batch/job.json. NOT_FOUND if `out` is not a data set of `duet batch`,
// FAILED_PRECONDITION if the file is damaged.
absl::StatusOr<v1::Job> ReadJob(const std::filesystem::path& out);

// The folder of a shard's data set: `out` itself unless there are several shards.
std::filesystem::path ShardFolder(const std::filesystem::path& out, const Shard& shard);

struct Gathered {
  int shards = 0;
  int count = 0;  // of the job
  int64_t items = 0;
};

// Moves what the shards of a job made, in the folders <out>/shard-INDEX-of-COUNT, into the set of
// `folder`, and removes their folders. A run without shards calls it before its survey, which
// compares the leaders and the makers of all items. `folder` is open for `wanted`; `begun` is the
// identity that it was begun with, and becomes that of the shards for a new set. It can be repeated
// after an interruption, and shards may be incomplete: the run makes what is missing.
//
// Errors: ABORTED if a shard is in use or a folder cannot be written; FAILED_PRECONDITION if a
// shard has another recipe or other models; DATA_LOSS for a damaged journal.
absl::StatusOr<Gathered> GatherShards(const v1::Job& wanted, const JobFolder& folder,
                                      v1::Job* begun);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOB_FOLDER_H_
