#include "client/batch/estimate.h"

#include <memory>
#include <optional>
#include <utility>

#include "client/batch/answer.h"
#include "client/batch/encode.h"
#include "client/batch/loaded_leader.h"

namespace duet::client::batch {
namespace {

constexpr size_t kProblemsKept = 20;

// One answer, for what it costs.
struct Probe {
  double seconds_a_frame = 0;
  double bytes_a_frame = 0;
};

absl::StatusOr<Probe> Ask(const Item& item, const Recipe& recipe, const ModelInfo& model,
                          const motion::Skeleton& skeleton, const LoadedLeader& leader,
                          const Client& client) {
  const absl::StatusOr<SynthesisResult> result =
      client.Synthesize(ToRequest(item, recipe, model, leader, 0));
  if (!result.ok()) return result.status();
  const double frames = result->pair.follower.frame_count();
  Probe probe;
  probe.seconds_a_frame = absl::ToDoubleSeconds(result->timings.total) / frames;
  const absl::StatusOr<std::vector<EncodedFile>> files =
      Encode(recipe.output, item.side, AtOutputRate(result->pair, recipe.output), skeleton);
  if (!files.ok()) return files.status();
  for (const EncodedFile& file : *files) {
    probe.bytes_a_frame += static_cast<double>(file.content.size()) / frames;
  }
  return probe;
}

}  // namespace

absl::StatusOr<Estimate> EstimateJob(const Recipe& recipe, const std::vector<ModelInfo>& models,
                                     const std::vector<motion::Skeleton>& skeletons,
                                     const Shard& shard, int64_t limit, const Client& client,
                                     Plan* plan) {
  Estimate estimate;
  std::optional<Probe> probe;
  std::shared_ptr<const LeaderEntry> entry;
  formats::Side side = formats::Side::kLeft;
  absl::StatusOr<LoadedLeader> leader;
  for (int64_t number = 0; number < limit; ++number) {
    absl::StatusOr<std::optional<Item>> item = plan->Next();
    if (!item.ok()) return item.status();
    if (!item->has_value()) break;
    if (!shard.Has((*item)->id)) continue;
    ++estimate.items;
    const auto model = static_cast<size_t>((*item)->model);
    if ((*item)->leader != entry || (*item)->side != side) {
      entry = (*item)->leader;
      side = (*item)->side;
      leader = LoadLeader(*entry, side, recipe.input, skeletons[model]);
      ++estimate.leaders;
      if (!leader.ok()) {
        ++estimate.unreadable;
        if (estimate.problems.size() < kProblemsKept) {
          estimate.problems.emplace_back(leader.status().message());
        }
      }
    }
    if (!leader.ok()) continue;
    estimate.frames += leader->clip.frame_count();
    if (probe.has_value()) continue;
    absl::StatusOr<Probe> asked =
        Ask(**item, recipe, models[model], skeletons[model], *leader, client);
    if (!asked.ok()) return asked.status();
    probe = *asked;
  }
  if (probe.has_value()) {
    estimate.seconds = probe->seconds_a_frame * static_cast<double>(estimate.frames);
    estimate.bytes = probe->bytes_a_frame * static_cast<double>(estimate.frames);
  }
  return estimate;
}

}  // namespace duet::client::batch
