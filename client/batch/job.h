#ifndef DUET_CLIENT_BATCH_JOB_H_
#define DUET_CLIENT_BATCH_JOB_H_

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "client/batch/answer.h"
#include "client/batch/durable_file.h"
#include "client/batch/flow/call_gate.h"
#include "client/batch/flow/queues.h"
#include "client/batch/index.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leaders.h"
#include "client/batch/plan.h"
#include "client/batch/survey.h"
#include "client/client.h"

namespace duet::client::batch {

struct JobOptions {
  flow::Options calls;
  // Maximum time for which the server may be away before the run ends.
  flow::Duration patience = std::chrono::minutes(2);
  int64_t limit = std::numeric_limits<int64_t>::max();  // only the first items of the plan
};

// Progress of a run, in items.
struct Progress {
  int64_t resumed = 0;  // items of the run that earlier runs settled
  int64_t done = 0;     // by this run, like all counts below
  int64_t rejected = 0;
  int64_t failed = 0;      // permanently
  int64_t unfinished = 0;  // failed temporarily
  flow::CallGate::State calls;
};

// How a run ended.
struct JobReport {
  SetCounts set;        // the content of the data set now
  int64_t planned = 0;  // items of the finished data set
  int64_t unfinished = 0;
  std::string first_unfinished;  // why the first of them failed
  // Why the run ended early; OK if it did not, or if Stop ended it.
  absl::Status stopped;
  bool complete() const { return set.done + set.rejected + set.failed >= planned; }
};

// One run of a batch: requests every item of a plan that is not settled yet, stores the answers,
// and writes the index. Reading, calls and writing overlap. An item passes from the feeder (reads
// the plan) to an asker (reads the leader, calls the server, judges the answer, encodes its files)
// and to the writer, which writes many items to disk at once. There are more askers than calls that
// may be in flight.
//
// An item is settled when its files and then its journal record are on disk. Whenever the process
// ends, the next run requests the items that are not settled again, gets the same answers and
// writes the same files.
class Job {
 public:
  // The source is that of the plan. `client` does not retry. `folder` is open and was begun with
  // the recipe. `survey` covers the same part of the plan and the same folder; `planned` comes from
  // the check of that part.
  struct Parts : SetSource {
    Shard shard;
    Client client;
    const JobFolder* folder = nullptr;
    Survey* survey = nullptr;
    int64_t planned = 0;  // items of the part in the job's shard
  };
  // The plan begins with its first item.
  Job(Parts parts, Plan plan, const JobOptions& options);

  // Call once. Errors are caused by the input or the disk; items that were settled before are kept.
  absl::StatusOr<JobReport> Run();

  // Starts no more calls; calls in progress finish. Callable from any thread.
  void Stop();
  Progress progress() const;

 private:
  struct Work {
    Item item;
    std::shared_ptr<SharedLeader> leader;
    int retry = 0;     // selects the seed
    int attempts = 0;  // that failed temporarily
  };
  // An item with a final result, on its way to the disk.
  struct Settled {
    Item item;
    absl::string_view state;  // as in its record
    std::string record;
    std::vector<EncodedFile> files;
  };

  absl::Status Feed();
  void AskUntilDone();
  bool Ask(Work* work);
  bool HandleFailure(const absl::Status& status, Work* work);
  bool Judge(SynthesisResult result, Work* work);
  void Keep(const Item& item, const Answer& answer);
  void Fail(const Item& item, const absl::Status& error);
  void FailForNow(const Item& item, const absl::Status& error);
  void Settle(Settled settled);
  void WriteUntilClosed(JournalWriter* journal);
  absl::Status Write(const std::vector<Settled>& all, FileGroup* files, JournalWriter* journal);
  absl::Status RunThreads(JournalWriter* writer);
  absl::StatusOr<JobReport> Finish();
  void StopWith(const absl::Status& status);

  Parts parts_;
  Plan plan_;
  JobOptions options_;
  flow::CallGate gate_;
  flow::Queue<Work> queue_;
  flow::Queue<Settled> settled_;  // by bytes

  const std::vector<int> skeleton_indices_;  // of dataset.json, by model
  LastLeaders leaders_;                      // used only by Feed

  std::atomic<int64_t> resumed_{0}, done_{0}, rejected_{0}, failed_{0};
  std::atomic<int64_t> unfinished_{0};
  std::mutex unfinished_mutex_;
  std::string first_unfinished_;
  std::mutex stop_mutex_;
  absl::Status stopped_with_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOB_H_
