#ifndef DUET_CLIENT_BATCH_JOB_H_
#define DUET_CLIENT_BATCH_JOB_H_

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "client/batch/answer.h"
#include "client/batch/damage.h"
#include "client/batch/failures.h"
#include "client/batch/flow/bounded_queue.h"
#include "client/batch/flow/call_gate.h"
#include "client/batch/flow/work_queue.h"
#include "client/batch/index.h"
#include "client/batch/item_files.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leader_sharing.h"
#include "client/batch/plan.h"
#include "client/batch/survey.h"
#include "client/client.h"

namespace duet::client::batch {

struct JobOptions {
  flow::Options calls;
  // How long servers may be away before the run ends.
  flow::Duration patience = std::chrono::minutes(2);
  // A part of the plan: its first items, and of these a share that is chosen by hash.
  int64_t limit = std::numeric_limits<int64_t>::max();
  double share = 1;
  // Items whose failure was for good are asked for again.
  bool retry_failed = false;
};

// How far a run is. Counts of items.
struct Progress {
  int64_t planned = 0;  // that the run has come to so far
  int64_t resumed = 0;  // of these, settled by earlier runs
  int64_t done = 0;     // by this run, as are all below
  int64_t rejected = 0;
  int64_t failed = 0;      // for good
  int64_t unfinished = 0;  // failed for a passing reason
  uint64_t bytes = 0;
  flow::CallGate::State calls;
};

// How a run ended.
struct JobReport {
  SetCounts set;        // what is in the data set now
  int64_t planned = 0;  // items that should be in it
  int64_t unfinished = 0;
  bool packed = false;                          // in shards, which leave out what failed
  std::vector<FailureCause> unfinished_causes;  // the largest; without numbers of leaders
  // Why the run ended before all items were settled; OK when it was not, or when it was asked to.
  absl::Status stopped;
  bool complete() const { return set.done + set.rejected + set.failed >= planned; }
};

// One run of a batch: asks for every item of a plan that is not settled yet, keeps what comes, and
// writes the index. Reading, calls and writing overlap: an item goes from the feeder (its plan) to
// an asker (its leader, its turn at a server), to a keeper (what came: judged, put into files) and
// to the writer, which brings many items to the disk at once. Nobody waits for a call.
//
// An item is settled when its files are on the disk under their names and its record in the journal
// is as well, in this order: whenever the process ends, the next run asks again for what is not
// settled, gets the same and writes the same files.
class Job {
 public:
  // `servers`: for each the clients that take turns, each with one attempt and bulk priority of its
  // own accord. `models` and `skeletons` are the plan's. `folder` is open and begun as `identity`;
  // `survey` is of the plan's part and of this folder.
  struct Parts {
    Recipe recipe;
    JobIdentity identity;
    std::vector<ModelInfo> models;
    std::vector<motion::Skeleton> skeletons;
    RequestLimits limits;  // of the servers, where they are known
    std::vector<std::vector<Client>> servers;
    const JobFolder* folder = nullptr;
    const Survey* survey = nullptr;
    KeptLeaders* leaders = nullptr;  // read before; may be null
  };
  // The plan begins with its first item.
  Job(Parts parts, Plan plan, const JobOptions& options);

  // Once. An error is of the input or of the disk, before which everything settled is kept.
  absl::StatusOr<JobReport> Run();

  // Lets calls under way end and asks for nothing more. From any thread.
  void Stop();
  Progress progress() const;

 private:
  struct Work {
    Item item;
    std::shared_ptr<SharedLeader> leader;
    int retry = 0;     // which seed
    int attempts = 0;  // that failed for a passing reason
  };
  struct Answered {
    Work work;
    absl::StatusOr<SynthesisResult> result;
  };
  // An item that is known for good, on its way to the disk.
  struct Settled {
    Item item;
    absl::string_view state;  // as its record tells
    std::string record;
    std::vector<ItemFile> files;
  };

  absl::Status Feed();
  bool Put(Item item);
  void AskUntilDone();
  void Ask(Work work);
  void KeepUntilClosed();
  void Receive(Answered answered);
  void Judge(Work work, const SynthesisResult& result);
  void Keep(const Item& item, const RecordedAnswer& answer, const motion::ClipPair& pair);
  void Fail(const Item& item, const absl::Status& error);
  void FailForNow(const Item& item, const absl::Status& error);
  void Settle(Settled settled);
  void WriteUntilClosed(JournalWriter* journal);
  absl::Status Write(const std::vector<Settled>& all, ItemWriter* items, JournalWriter* journal);
  void Count(const Settled& settled);
  absl::Status RunThreads(JournalWriter* writer);
  bool IsComplete() const;
  absl::Status DrawContactSheet(const JournalReader& journal) const;
  absl::Status PackOrRepaired(const JournalReader& journal);
  absl::StatusOr<JobReport> Finish();
  void StopWith(const absl::Status& status);
  Client& NextClient(int server);

  Parts parts_;
  Plan plan_;
  JobOptions options_;
  flow::CallGate gate_;
  flow::WorkQueue<Work> queue_;
  flow::BoundedQueue<Answered> answers_;
  flow::BoundedQueue<Settled> settled_;  // by bytes

  const std::vector<int> skeleton_indices_;  // of dataset.json, by model
  LastLeaders leaders_;                      // used only by Feed

  std::atomic<int64_t> planned_{0}, resumed_{0}, done_{0}, rejected_{0}, failed_{0};
  std::atomic<int64_t> unfinished_{0};
  std::atomic<uint64_t> bytes_{0}, turns_{0};
  std::mutex unfinished_mutex_;
  FailureCauses unfinished_causes_;
  bool fed_ = false;  // Feed came to the part's end
  Damage damage_;     // that was found before, less what was settled; the writer's alone
  std::mutex stop_mutex_;
  absl::Status stopped_with_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOB_H_
