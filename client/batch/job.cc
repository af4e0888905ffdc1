#include "client/batch/job.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/error_details.h"

namespace duet::client::batch {
namespace {

constexpr int kAttempts = 3;  // of a call that fails temporarily
constexpr size_t kQueuedItems = 64;
// Askers beyond the calls in flight, which read leaders and encode answers meanwhile.
constexpr int kMoreAskers = 4;
constexpr size_t kUnwrittenBytes = size_t{64} << 20;
// How long items are collected before they are flushed to disk together. A flush costs as much as
// several items, and an item that is lost before the flush is requested again.
constexpr flow::Duration kGatherTime = std::chrono::milliseconds(100);

std::optional<flow::Duration> DelayOf(const absl::Status& status) {
  const std::optional<absl::Duration> delay = RetryDelay(status);
  if (!delay.has_value()) return std::nullopt;
  return absl::ToChronoNanoseconds(*delay);
}

}  // namespace

Job::Job(Parts parts, Plan plan, const JobOptions& options)
    : parts_(std::move(parts)),
      plan_(std::move(plan)),
      options_(options),
      gate_(options.calls, options.patience),
      queue_(kQueuedItems),
      settled_(kUnwrittenBytes),
      skeleton_indices_(SkeletonIndices(parts_.skeletons)),
      leaders_(parts_.models.size()) {}

void Job::Stop() {
  gate_.Stop();
  queue_.Stop();
}

void Job::StopWith(const absl::Status& status) {
  {
    const std::lock_guard<std::mutex> lock(stop_mutex_);
    stopped_with_.Update(status);
  }
  Stop();
}

Progress Job::progress() const {
  return {resumed_, done_, rejected_, failed_, unfinished_, gate_.state()};
}

absl::Status Job::Feed() {
  for (int64_t planned = 0; planned < parts_.planned;) {
    absl::StatusOr<std::optional<Item>> item = plan_.Next();
    if (!item.ok()) return item.status();
    if (!item->has_value() || (*item)->number >= options_.limit) {
      return absl::AbortedError("the list of leaders was changed during the run");
    }
    if (!parts_.shard.Has((*item)->place)) continue;
    ++planned;
    if (parts_.survey->IsSettled((*item)->number)) {
      ++resumed_;
      continue;
    }
    std::shared_ptr<SharedLeader> leader = leaders_.Get(
        (*item)->leader, (*item)->side, skeleton_indices_[static_cast<size_t>((*item)->model)]);
    const bool stopped = !queue_.Put({**std::move(item), std::move(leader)});
    if (stopped) return absl::OkStatus();
  }
  return absl::OkStatus();
}

void Job::AskUntilDone() {
  while (std::optional<Work> work = queue_.Take()) {
    bool again = true;
    while (again) again = Ask(&*work);
  }
}

// Makes one call for an item. Returns whether it needs another one.
bool Job::Ask(Work* work) {
  const auto model = static_cast<size_t>(work->item.model);
  const absl::StatusOr<LoadedLeader>& leader =
      work->leader->Get(parts_.recipe.input, parts_.skeletons[model]);
  if (!leader.ok()) {
    Fail(work->item, leader.status());
    return false;
  }
  const absl::Status unchanged = parts_.survey->CheckLeader(*work->item.leader, leader->sha256);
  if (!unchanged.ok()) {
    StopWith(unchanged);
    return false;
  }
  const SynthesisRequest request =
      ToRequest(work->item, parts_.recipe, parts_.models[model], *leader, work->retry);
  const std::optional<int64_t> call = gate_.Start();
  if (!call.has_value()) {
    queue_.Stop();  // no more calls start
    return false;
  }
  absl::StatusOr<SynthesisResult> result = parts_.client.Synthesize(request);
  gate_.Finish(*call, CallEndOf(result.status()), DelayOf(result.status()));
  return result.ok() ? Judge(*std::move(result), work) : HandleFailure(result.status(), work);
}

bool Job::HandleFailure(const absl::Status& status, Work* work) {
  switch (MeaningOf(status)) {
    case Meaning::kWait:
      return true;
    case Meaning::kTryAgain:
      if (++work->attempts < kAttempts) return true;
      FailForNow(work->item, status);
      return false;
    case Meaning::kRefused:
      Fail(work->item, status);
      return false;
    case Meaning::kStop:
      StopWith(status);
      return false;
  }
  return false;
}

// Settles an item that has an answer, unless it needs another one.
bool Job::Judge(SynthesisResult result, Work* work) {
  const absl::Status same = parts_.survey->CheckMaker(ModelText(result), MadeByOf(result));
  if (!same.ok()) {
    StopWith(same);
    return false;
  }
  result.pair = AtOutputRate(std::move(result.pair), parts_.recipe.output);
  const auto model = static_cast<size_t>(work->item.model);
  const motion::Skeleton& skeleton = parts_.skeletons[model];
  const Answer answer{result, *work->leader->Get(parts_.recipe.input, skeleton),
                      Measure(result, skeleton, parts_.recipe.input.up), skeleton_indices_[model],
                      work->retry};
  const v1::QualityFilter& filter = parts_.recipe.filter;
  const std::vector<std::string> reasons = WhyRejected(filter, answer.quality);
  if (reasons.empty()) {
    Keep(work->item, answer);
    return false;
  }
  if (parts_.models[model].samples && work->retry < static_cast<int>(filter.retries_per_item())) {
    ++work->retry;
    return true;
  }
  Settle({work->item, kRejected, Line(RejectedRecord(work->item, answer, reasons)), {}});
  return false;
}

void Job::Keep(const Item& item, const Answer& answer) {
  const motion::Skeleton& skeleton = parts_.skeletons[static_cast<size_t>(item.model)];
  absl::StatusOr<std::vector<EncodedFile>> encoded =
      Encode(parts_.recipe.output, answer.result.pair, skeleton);
  if (!encoded.ok()) return Fail(item, encoded.status());
  Settle({item, kDone, Line(DoneRecord(item, answer, *encoded)), *std::move(encoded)});
}

void Job::Fail(const Item& item, const absl::Status& error) {
  Settle({item, kFailed, Line(FailedRecord(item, error)), {}});
}

// Writes no journal record, so the next run requests the item again.
void Job::FailForNow(const Item& item, const absl::Status& error) {
  const std::lock_guard<std::mutex> lock(unfinished_mutex_);
  if (unfinished_++ == 0) first_unfinished_ = absl::StrCat(item.name, ": ", error.message());
}

void Job::Settle(Settled settled) {
  size_t bytes = settled.record.size();
  for (const EncodedFile& file : settled.files) bytes += file.content.size();
  settled_.Put(std::move(settled), bytes);
}

// Flushes many items at once.
void Job::WriteUntilClosed(JournalWriter* journal) {
  FileGroup files(parts_.folder->temporary(), parts_.folder->out());
  for (std::vector<Settled> all; !(all = settled_.Gather(kGatherTime)).empty();) {
    const absl::Status status = Write(all, &files, journal);
    if (status.ok()) continue;
    settled_.Stop();
    return StopWith(status);
  }
}

// Writes files before records, so that a record never names a missing file.
absl::Status Job::Write(const std::vector<Settled>& all, FileGroup* files, JournalWriter* journal) {
  for (const Settled& settled : all) {
    for (const EncodedFile& file : settled.files) {
      absl::Status added = files->Add(settled.item.name + file.ending, file.content);
      if (!added.ok()) return added;
    }
    journal->Add(settled.item.number, settled.record);
  }
  absl::Status status = files->Commit();
  if (status.ok()) status = journal->Commit();
  if (!status.ok()) return status;
  for (const Settled& settled : all) {
    ++(settled.state == kDone ? done_ : settled.state == kFailed ? failed_ : rejected_);
  }
  return absl::OkStatus();
}

absl::Status Job::RunThreads(JournalWriter* writer) {
  std::thread on_disk([this, writer] { WriteUntilClosed(writer); });
  std::vector<std::thread> askers;
  for (int i = 0; i < options_.calls.max_in_flight + kMoreAskers; ++i) {
    askers.emplace_back([this] { AskUntilDone(); });
  }
  const absl::Status fed = Feed();
  queue_.Close();
  if (!fed.ok()) Stop();
  for (std::thread& asker : askers) asker.join();
  settled_.Close();
  on_disk.join();
  return fed;
}

absl::StatusOr<JobReport> Job::Finish() {
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(parts_.folder->journal());
  if (!journal.ok()) return journal.status();
  JobReport report;
  // A run that was stopped has not reached all of them. Earlier runs may have settled more.
  report.planned = std::max<int64_t>(parts_.planned, journal->count());
  report.unfinished = unfinished_;
  report.first_unfinished = first_unfinished_;
  absl::StatusOr<SetCounts> counts = WriteIndex(*journal, parts_, report.planned, *parts_.folder);
  if (!counts.ok()) return counts.status();
  report.set = *std::move(counts);
  return report;
}

absl::StatusOr<JobReport> Job::Run() {
  const JobFolder& folder = *parts_.folder;
  JournalWriter writer;
  absl::Status status = writer.Open(folder.journal(), parts_.survey->journal().size());
  if (!status.ok()) return status;
  status = RunThreads(&writer);
  if (!status.ok()) return status;
  absl::StatusOr<JobReport> report = Finish();
  if (!report.ok()) return stopped_with_.ok() ? report : stopped_with_;
  report->stopped = stopped_with_;
  if (gate_.state().lost_patience) {
    report->stopped.Update(absl::UnavailableError("no server answered within --patience"));
  }
  return report;
}

}  // namespace duet::client::batch
