#include "client/batch/estimate.h"

#include "client/batch/answer.h"
#include "client/batch/encode.h"
#include "client/batch/loaded_leader.h"

namespace duet::client::batch {

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
