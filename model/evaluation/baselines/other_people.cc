#include "model/evaluation/baselines/other_people.h"

#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/random.h"
#include "model/evaluation/baselines/motion_matrix.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::baselines {
namespace {

using dataset::Sequence;

// The captured followers of a class that can answer a clip of `frames` frames.
std::vector<const Sequence*> Candidates(const dataset::Dataset& dataset,
                                        const std::vector<int>& train, int interaction_class,
                                        int frames) {
  std::vector<const Sequence*> all, enough;
  for (const int index : train) {
    const Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    if (sequence.interaction_class != interaction_class) continue;
    all.push_back(&sequence);
    if (sequence.pair.leader.frame_count() >= frames) enough.push_back(&sequence);
  }
  return enough.empty() ? all : enough;
}

}  // namespace

absl::StatusOr<std::vector<motion::Poses>> AnswerWithOtherPeople(const dataset::Dataset& dataset,
                                                                 const std::vector<int>& train,
                                                                 const std::vector<int>& test,
                                                                 uint64_t seed) {
  constexpr auto kFirstFrame = motion::StandardOrigin::kFirstFrame;
  base::Random random(seed);
  std::vector<motion::Poses> answers;
  for (const int index : test) {
    const Sequence& asked = dataset.sequences[static_cast<size_t>(index)];
    const int frames = asked.pair.leader.frame_count();
    const auto candidates = Candidates(dataset, train, asked.interaction_class, frames);
    if (candidates.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "other people: expected at least one training sequence of class ",
          dataset.classes[static_cast<size_t>(asked.interaction_class)], ", got none"));
    }
    const auto drawn = random.Below(static_cast<int64_t>(candidates.size()));
    const Sequence& other = *candidates[static_cast<size_t>(drawn)];
    const Rows motion = ToRows(BaselineStandardisation(dataset.skeleton, other, kFirstFrame)
                                   .Apply(other.pair.follower.poses));
    answers.push_back(BaselineStandardisation(dataset.skeleton, asked, kFirstFrame)
                          .Invert(FromRows(motion.rows() < frames ? StretchTo(motion, frames)
                                                                  : Rows(motion.topRows(frames)))));
  }
  return answers;
}

}  // namespace duet::evaluation::baselines
