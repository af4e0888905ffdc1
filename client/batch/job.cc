#include "client/batch/job.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/contact_sheet.h"
#include "client/batch/encode.h"
#include "client/batch/packing.h"
#include "client/error_details.h"
#include "model/base/sha256.h"
#include "nlohmann/json.hpp"

namespace duet::client::batch {
namespace {

constexpr int kAttempts = 3;      // at a call that fails for a passing reason
constexpr int kReadingAhead = 4;  // threads beyond those that may have a call under way
constexpr size_t kQueuedItems = 64;
constexpr size_t kQueuedRecords = 4096;

std::optional<flow::Duration> DelayOf(const absl::Status& status) {
  const std::optional<absl::Duration> delay = RetryDelay(status);
  if (!delay.has_value()) return std::nullopt;
  return absl::ToChronoNanoseconds(*delay);
}

// Whether an item is in a share of the plan: a hash of its id that no shard's hash looks at.
bool InShare(const Item& item, double share) {
  if (share >= 1) return true;
  return std::stoul(item.id.substr(8, 8), nullptr, 16) < share * 4294967296.0;
}

}  // namespace

Job::Job(Parts parts, Plan plan, const JobOptions& options)
    : parts_(std::move(parts)),
      plan_(std::move(plan)),
      options_(options),
      gate_(static_cast<int>(parts_.servers.size()), options.calls, options.patience),
      queue_(kQueuedItems),
      settled_(kQueuedRecords),
      leaders_(parts_.models.size()) {}

Client& Job::NextClient(int server) {
  std::vector<Client>& clients = parts_.servers[static_cast<size_t>(server)];
  return clients[turns_++ % clients.size()];
}

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
  return {planned_, resumed_, done_, rejected_, failed_, unfinished_, bytes_, gate_.state()};
}

absl::StatusOr<bool> Job::IsSettled(const Item& item, const JournalReader& journal) const {
  if (!journal.Has(item.number)) return false;
  const absl::StatusOr<std::string> text = journal.Read(item.number);
  if (!text.ok()) return text.status();
  const auto record = nlohmann::json::parse(*text, nullptr, false);
  const std::string id = record.is_object() ? record.value("id", "") : "";
  if (id != item.id) {
    return absl::FailedPreconditionError(absl::StrCat(
        parts_.folder->out().string(), ": item ", item.number, " was ",
        record.is_object() ? record.value("name", "") : "", " and is ", item.name,
        " now; wanted the same leaders in the same order, new ones at the end, or another --out"));
  }
  return !options_.retry_failed || record.value("state", "") != kFailed;
}

// False when the run is being stopped.
bool Job::Put(Item item) {
  std::shared_ptr<SharedLeader> leader = leaders_.Get(item.leader, item.side, item.model);
  return queue_.Put({std::move(item), std::move(leader)});
}

absl::Status Job::Feed(const JournalReader& journal) {
  for (int64_t number = 0; number < options_.limit; ++number) {
    absl::StatusOr<std::optional<Item>> item = plan_.Next();
    if (!item.ok()) return item.status();
    if (!item->has_value()) {
      whole_plan_ = options_.share >= 1;
      return absl::OkStatus();
    }
    if (!parts_.identity.shard.Has((*item)->id) || !InShare(**item, options_.share)) continue;
    const absl::StatusOr<bool> settled = IsSettled(**item, journal);
    if (!settled.ok()) return settled.status();
    ++planned_;
    if (!*settled && packed_) {
      return absl::FailedPreconditionError(
          absl::StrCat(parts_.folder->out().string(), ": is packed and takes no more items, but ",
                       (*item)->name, " came; wanted another --out"));
    }
    if (*settled) {
      ++resumed_;
    } else if (!Put(**std::move(item))) {
      return absl::OkStatus();
    }
  }
  return absl::OkStatus();
}

void Job::WorkUntilDone() {
  while (std::optional<Work> work = queue_.Take()) {
    const absl::Status status = Make(*work);
    if (!status.ok()) return StopWith(status);
  }
}

absl::Status Job::Make(const Work& work) {
  const Item& item = work.item;
  const auto model = static_cast<size_t>(item.model);
  const absl::StatusOr<LoadedLeader>& leader =
      work.leader->Get(parts_.recipe.input, parts_.skeletons[model]);
  if (!leader.ok()) return Fail(item, leader.status());
  for (int retry = 0, attempts = 0;;) {
    const SynthesisRequest request =
        ToRequest(item, parts_.recipe, parts_.models[model], *leader, retry);
    const std::optional<flow::ServerChoice::Call> call = gate_.Start();
    if (!call.has_value()) {
      queue_.Stop();  // nobody gets a call any longer
      return absl::OkStatus();
    }
    absl::StatusOr<SynthesisResult> result = NextClient(call->server).Synthesize(request);
    gate_.Finish(*call, CallEndOf(result.status()), DelayOf(result.status()));
    switch (MeaningOf(result.status())) {
      case Meaning::kAnswer: {
        bool again = false;
        result->pair = AtOutputRate(std::move(result->pair), parts_.recipe.output);
        absl::Status status = Judge(work, request, *result, retry, &again);
        if (!again || !status.ok()) return status;
        ++retry;
        break;
      }
      case Meaning::kWait:
        break;
      case Meaning::kTryAgain:
        if (++attempts < kAttempts) break;
        FailForNow(item, result.status());
        return absl::OkStatus();
      case Meaning::kRefused:
        return Fail(item, result.status());
      case Meaning::kStop:
        return result.status();
    }
  }
}

absl::Status Job::Judge(const Work& work, const SynthesisRequest& request,
                        const SynthesisResult& result, int retry, bool* again) {
  const auto model = static_cast<size_t>(work.item.model);
  const motion::Skeleton& skeleton = parts_.skeletons[model];
  const QualityFilter& filter = parts_.recipe.filter;
  const RecordedAnswer answer = ToRecorded(
      request, result, *work.leader->Get(parts_.recipe.input, skeleton), skeleton, retry);
  const std::vector<std::string> reasons =
      WhyRejected(filter, answer.quality, answer.unfamiliarity);
  if (reasons.empty()) return Keep(work.item, answer, result.pair);
  *again = parts_.models[model].samples && retry < filter.retries_per_item;
  if (*again) return absl::OkStatus();
  RemoveError(work.item);
  ++rejected_;
  Settle(work.item, RejectedRecord(work.item, answer, reasons), {});
  return absl::OkStatus();
}

absl::Status Job::Keep(const Item& item, const RecordedAnswer& answer,
                       const motion::ClipPair& pair) {
  const std::filesystem::path root = parts_.folder->items(parts_.identity.packing);
  const motion::Skeleton& skeleton = parts_.skeletons[static_cast<size_t>(item.model)];
  std::vector<RecordedFile> files;
  const absl::StatusOr<std::vector<EncodedFile>> encoded =
      Encode(parts_.recipe.output, item.side, pair, skeleton);
  if (!encoded.ok()) return Fail(item, encoded.status());
  for (const EncodedFile& file : *encoded) {
    const std::string path = item.name + file.ending;
    const std::filesystem::path temporary =
        parts_.folder->temporary() / absl::StrCat(item.number, file.ending);
    absl::Status status = WriteDurably(temporary, root / path, file.content);
    if (!status.ok()) return status;
    files.push_back({path, file.content.size(), base::Sha256Hex(file.content)});
    bytes_ += file.content.size();
  }
  RemoveError(item);
  ++done_;
  Settle(item, DoneRecord(item, answer, files), {(root / item.name).parent_path()});
  return absl::OkStatus();
}

absl::Status Job::Fail(const Item& item, const absl::Status& error) {
  WriteError(item, error);
  ++failed_;
  Settle(item, FailedRecord(item, error), {});
  return absl::OkStatus();
}

void Job::FailForNow(const Item& item, const absl::Status& error) {
  WriteError(item, error);
  ++unfinished_;
}

std::filesystem::path Job::ErrorFile(const Item& item) const {
  return parts_.folder->errors() / (item.name + ".json");
}

// For people; where it cannot be written, the journal tells the same.
void Job::WriteError(const Item& item, const absl::Status& error) {
  errors_exist_ = true;
  (void)WriteDurably(parts_.folder->temporary() / absl::StrCat(item.number, ".error"),
                     ErrorFile(item), Line(FailedRecord(item, error)) + "\n");
}

void Job::RemoveError(const Item& item) {
  std::error_code error;
  if (errors_exist_) std::filesystem::remove(ErrorFile(item), error);
}

void Job::Settle(const Item& item, const nlohmann::ordered_json& record,
                 std::vector<std::filesystem::path> folders) {
  settled_.Put({item.number, Line(record), std::move(folders)});
}

// Many items share one look at the disk.
void Job::CommitUntilClosed(JournalWriter* writer) {
  for (std::vector<Settled> all; !(all = settled_.TakeAll()).empty();) {
    std::set<std::filesystem::path> folders;
    for (const Settled& settled : all) {
      folders.insert(settled.folders.begin(), settled.folders.end());
      writer->Add(settled.item, settled.record);
    }
    absl::Status status;
    for (const std::filesystem::path& folder : folders) status.Update(SyncFolder(folder));
    if (status.ok()) status = writer->Commit();
    if (status.ok()) continue;
    settled_.Stop();
    return StopWith(status);
  }
}

absl::Status Job::RunThreads(const JournalReader& journal, JournalWriter* writer) {
  std::thread committer([this, writer] { CommitUntilClosed(writer); });
  std::vector<std::thread> workers;
  const int calls = options_.calls.max_in_flight * static_cast<int>(parts_.servers.size());
  for (int i = 0; i < calls + kReadingAhead; ++i) {
    workers.emplace_back([this] { WorkUntilDone(); });
  }
  const absl::Status fed = Feed(journal);
  queue_.Close();
  if (!fed.ok()) Stop();
  for (std::thread& worker : workers) worker.join();
  settled_.Close();
  committer.join();
  return fed;
}

absl::StatusOr<JobReport> Job::Finish() {
  const JobFolder& folder = *parts_.folder;
  const JobIdentity& identity = parts_.identity;
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(folder.journal());
  if (!journal.ok()) return journal.status();
  JobReport report;
  report.planned = std::max<int64_t>(planned_, journal->count());
  report.unfinished = unfinished_;
  // A shard of a set that is made in several is packed when they are merged.
  const bool packs = whole_plan_ && journal->count() == planned_ && identity.shard.count == 1;
  absl::Status status;
  // What is in shards by now was drawn when it was not.
  if (!packed_) {
    status = WriteContactSheet(*journal, identity, folder.items(identity.packing), folder.out());
  }
  if (status.ok() && packs && identity.packing != Packing::kNone) {
    status = Pack(*journal, identity.packing, identity.shard_bytes, folder.items(identity.packing),
                  folder.temporary(), folder.out());
  }
  if (!status.ok()) return status;
  absl::StatusOr<SetCounts> counts = WriteIndex(*journal, identity, {report.planned, whole_plan_},
                                                folder.temporary(), folder.out());
  if (!counts.ok()) return counts.status();
  report.set = *counts;
  return report;
}

absl::StatusOr<JobReport> Job::Run() {
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(parts_.folder->journal());
  if (!journal.ok()) return journal.status();
  JournalWriter writer;
  absl::Status status = writer.Open(parts_.folder->journal(), journal->size());
  if (!status.ok()) return status;
  std::error_code error;
  errors_exist_ = std::filesystem::exists(parts_.folder->errors(), error);
  const JobIdentity& identity = parts_.identity;
  packed_ = IsPacked(identity.packing, identity.shard_bytes, parts_.folder->out());
  status = RunThreads(*journal, &writer);
  if (!status.ok()) return status;
  absl::StatusOr<JobReport> report = Finish();
  if (!report.ok()) return stopped_with_.ok() ? report : stopped_with_;
  report->stopped = stopped_with_;
  if (gate_.state().lost_patience) {
    report->stopped.Update(absl::UnavailableError("no server answered for too long"));
  }
  return report;
}

}  // namespace duet::client::batch
