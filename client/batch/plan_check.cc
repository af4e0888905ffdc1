#include "client/batch/plan_check.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "absl/hash/hash.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/batch/answer.h"
#include "client/batch/dataset_json.h"
#include "client/batch/encode.h"
#include "client/batch/flow/queues.h"
#include "model/base/counted.h"
#include "model/motion/resample.h"

namespace duet::client::batch {
namespace {

constexpr size_t kQueuedLeaders = 64;

int FramesAsWritten(const motion::Clip& clip, const v1::Output& output) {
  const std::optional<double> rate_hz = RateOf(output);
  if (!rate_hz || clip.frame_count() < 2) return clip.frame_count();
  return motion::ResampledFrameCount(clip.frame_count(), clip.frame_rate_hz, *rate_hz);
}

// A leader, and its items in the part.
struct LeaderItems {
  std::shared_ptr<SharedLeader> leader;
  std::optional<Item> first;
  int64_t all = 0;
  int64_t unsettled = 0;
};

class Checker {
 public:
  Checker(const Recipe& recipe, const std::vector<motion::Skeleton>& skeletons,
          const RequestLimits& limits)
      : recipe_(recipe),
        skeletons_(skeletons),
        limits_(limits),
        // Models with the same skeleton read a leader in the same way.
        skeleton_of_model_(SkeletonIndices(skeletons)),
        sharing_(skeletons.size()),
        current_(skeletons.size()),
        queue_(kQueuedLeaders) {}

  absl::Status Run(const PlanPart& part, Plan* plan, const std::function<bool()>& stopped) {
    std::vector<std::thread> readers;
    for (int i = 0; i < std::clamp<int>(std::thread::hardware_concurrency(), 1, 8); ++i) {
      readers.emplace_back([this] {
        while (std::optional<LeaderItems> items = queue_.Take()) Read(*items);
      });
    }
    absl::Status status = Walk(part, plan, stopped);
    for (LeaderItems& items : current_) Hand(&items);
    queue_.Close();
    for (std::thread& reader : readers) reader.join();
    return status;
  }

  PlanCheck Result() {
    check_.files = static_cast<int64_t>(files_.size());
    check_.bad_leader_count = static_cast<int64_t>(bad_.size());
    std::vector<std::pair<int64_t, BadLeader>> bad;
    for (auto& [message, found] : bad_) bad.push_back({found.first, {message, found.second}});
    std::sort(bad.begin(), bad.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [number, leader] : bad) {
      if (check_.bad_leaders.size() == PlanCheck::kListed) break;
      check_.bad_leaders.push_back(std::move(leader));
    }
    return std::move(check_);
  }

 private:
  absl::Status Walk(const PlanPart& part, Plan* plan, const std::function<bool()>& stopped) {
    check_.whole_plan = part.share >= 1;
    while (!stopped()) {
      const absl::StatusOr<std::optional<Item>> item = plan->Next();
      if (absl::IsInvalidArgument(item.status())) {
        AddBadLine(item.status());
        continue;
      }
      if (!item.ok()) return item.status();
      if (!item->has_value()) break;
      if ((*item)->number >= part.limit) check_.whole_plan = false;
      if (!part.Has(**item)) continue;
      absl::StatusOr<bool> settled = false;
      if (part.is_settled && check_.bad_line_count == 0) settled = part.is_settled(**item);
      if (!settled.ok()) return settled.status();
      Add(**item, *settled);
    }
    return absl::OkStatus();
  }

  void AddBadLine(const absl::Status& status) {
    if (check_.bad_line_count++ >= static_cast<int64_t>(PlanCheck::kListed)) return;
    check_.bad_lines.emplace_back(status.message());
  }

  void Add(const Item& item, bool settled) {
    ++check_.items;
    const int skeleton = skeleton_of_model_[static_cast<size_t>(item.model)];
    std::shared_ptr<SharedLeader> leader = sharing_.Get(item.leader, item.side, skeleton);
    LeaderItems& current = current_[static_cast<size_t>(skeleton)];
    if (leader != current.leader) {
      Hand(&current);
      current.leader = std::move(leader);
      current.first = item;
    }
    if (item.leader != last_entry_ || item.side != last_side_) ++check_.leaders;
    if (item.leader != last_entry_) files_.insert(absl::Hash<std::string>()(item.leader->given));
    last_entry_ = item.leader;
    last_side_ = item.side;
    ++current.all;
    if (!settled) ++current.unsettled;
  }

  void Hand(LeaderItems* items) {
    if (items->unsettled > 0) queue_.Put(std::move(*items));
    *items = {};
  }

  void Read(const LeaderItems& items) {
    const auto model = static_cast<size_t>(items.first->model);
    const absl::StatusOr<LoadedLeader>& leader =
        items.leader->Get(recipe_.input, skeletons_[model], limits_);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!leader.ok()) {
      AddBad(items, leader.status());
      return;
    }
    const motion::Clip& clip = leader->clip;
    check_.frames += items.all * FramesAsWritten(clip, recipe_.output);
    check_.seconds += static_cast<double>(items.all) * clip.frame_count() / clip.frame_rate_hz;
    if (!check_.first_item || items.first->number < check_.first_item->number) {
      check_.first_item = items.first;
    }
  }

  void AddBad(const LeaderItems& items, const absl::Status& status) {
    check_.items_of_bad_leaders += items.all;
    // A leader that is listed again has the same message, which is its key.
    auto& [number, count] =
        bad_.insert({std::string(status.message()), {items.first->number, 0}}).first->second;
    number = std::min(number, items.first->number);
    count += items.all;
  }

  const Recipe& recipe_;
  const std::vector<motion::Skeleton>& skeletons_;
  const RequestLimits& limits_;
  const std::vector<int> skeleton_of_model_;
  LastLeaders sharing_;
  std::vector<LeaderItems> current_;  // by skeleton
  std::shared_ptr<const LeaderEntry> last_entry_;
  absl::flat_hash_set<size_t> files_;  // hashes of leaders as listed
  formats::Side last_side_ = formats::Side::kLeft;
  flow::BoundedQueue<LeaderItems> queue_;
  std::mutex mutex_;
  // By message: the number of the first item, and the number of items.
  std::map<std::string, std::pair<int64_t, int64_t>> bad_;
  PlanCheck check_;
};

}  // namespace

bool PlanPart::Has(const Item& item) const {
  return item.number < limit && shard.Has(item.place) && InShare(item.place, share);
}

absl::StatusOr<PlanCheck> CheckPlan(const Recipe& recipe,
                                    const std::vector<motion::Skeleton>& skeletons,
                                    const RequestLimits& limits, const PlanPart& part, Plan* plan,
                                    const std::function<bool()>& stopped) {
  Checker checker(recipe, skeletons, limits);
  absl::Status status = checker.Run(part, plan, stopped);
  if (!status.ok()) return status;
  return checker.Result();
}

absl::Status BadLinesError(const PlanCheck& check) {
  if (check.bad_line_count == 0) return absl::OkStatus();
  std::string lines = absl::StrJoin(check.bad_lines, "\n  ");
  const auto more = check.bad_line_count - static_cast<int64_t>(check.bad_lines.size());
  if (more > 0) absl::StrAppend(&lines, "\n  and ", more, " more");
  return absl::InvalidArgumentError(absl::StrCat(base::Counted(check.bad_line_count, "bad line"),
                                                 "; no call was made:\n  ", lines));
}

absl::StatusOr<Estimate> EstimateJob(const Recipe& recipe, const std::vector<ModelInfo>& models,
                                     const std::vector<motion::Skeleton>& skeletons,
                                     const RequestLimits& limits, const PlanCheck& check,
                                     const Client& client) {
  if (!check.first_item) return Estimate();
  const Item& item = *check.first_item;
  const auto model = static_cast<size_t>(item.model);
  const absl::StatusOr<LoadedLeader> leader =
      LoadLeader(*item.leader, item.side, recipe.input, skeletons[model], limits);
  if (!leader.ok()) return leader.status();
  absl::StatusOr<SynthesisResult> result =
      client.Synthesize(ToRequest(item, recipe, models[model], *leader, 0));
  if (!result.ok()) return result.status();
  const motion::Clip& clip = leader->clip;
  const motion::ClipPair pair = AtOutputRate(std::move(result->pair), recipe.output);
  const absl::StatusOr<std::vector<EncodedFile>> files =
      Encode(recipe.output, item.side, pair, skeletons[model]);
  if (!files.ok()) return files.status();
  double bytes = 0;
  for (const EncodedFile& file : *files) bytes += static_cast<double>(file.content.size());
  Estimate estimate;
  // The network runs at its own frame rate, so the time depends on the duration of the motion.
  estimate.seconds = absl::ToDoubleSeconds(result->timings.total) * check.seconds *
                     clip.frame_rate_hz / clip.frame_count();
  estimate.bytes = bytes * static_cast<double>(check.frames) / pair.follower.frame_count();
  return estimate;
}

}  // namespace duet::client::batch
