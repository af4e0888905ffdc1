#include "model/evaluation/experiments/sampled_answers.h"

#include <cstddef>
#include <utility>

namespace duet::evaluation::experiments {
namespace {

std::vector<LabelledLeader> AskAll(const dataset::Dataset& dataset,
                                   const std::vector<int>& sequences, const AskedSamples& asked,
                                   int samples) {
  std::vector<LabelledLeader> leaders;
  for (int n = 0; n < samples; ++n) {
    for (const int index : sequences) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
      leaders.push_back(Ask(
          sequence, engine::LabelTrack(OneClass(dataset.class_count(), sequence.interaction_class)),
          asked, SeedOf(asked, dataset, index, n)));
    }
  }
  return leaders;
}

}  // namespace

LabelledLeader Ask(const dataset::Sequence& sequence, engine::LabelTrack labels,
                   const AskedSamples& asked, uint64_t seed) {
  return {&sequence,
          std::move(labels),
          {seed, asked.variety, asked.candidates},
          asked.tell_direction,
          asked.live_delay};
}

uint64_t SeedOf(const AskedSamples& asked, const dataset::Dataset& dataset, int sequence, int n) {
  const uint64_t set = asked.seed + static_cast<uint64_t>(n);
  return set * dataset.sequences.size() + static_cast<uint64_t>(sequence);
}

absl::StatusOr<metrics::SampledMotions> AnswerWithSamples(const engine::Synthesizer& synthesizer,
                                                          const dataset::Dataset& dataset,
                                                          const std::vector<int>& sequences,
                                                          StartGiven start,
                                                          const AskedSamples& asked) {
  absl::Status status = CheckModelTakes(synthesizer.description(), dataset, start);
  if (!status.ok()) return status;
  const int samples = synthesizer.description().samples ? asked.samples : 1;
  absl::StatusOr<std::vector<motion::Poses>> followers =
      SynthesizeSequences(synthesizer, AskAll(dataset, sequences, asked, samples), start);
  if (!followers.ok()) return followers.status();
  metrics::SampledMotions answers(static_cast<size_t>(samples));
  auto follower = followers->begin();
  for (std::vector<metrics::ScoredMotion>& set : answers) {
    for (const int index : sequences) set.push_back({index, std::move(*follower++)});
  }
  return answers;
}

}  // namespace duet::evaluation::experiments
