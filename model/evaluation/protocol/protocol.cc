#include "model/evaluation/protocol/protocol.h"

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::evaluation::protocol {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The sequence as a method may see it: all of the follower but its first pose is made unusable, so
// that a method that peeks fails loudly instead of scoring well.
dataset::Sequence WithoutAnswer(const dataset::Sequence& sequence, int joints,
                                bool keep_first_pose) {
  dataset::Sequence hidden = sequence;
  std::vector<motion::Vec3>& follower = hidden.pair.follower.positions;
  if (!keep_first_pose) {
    follower.clear();
  } else {
    follower.resize(static_cast<size_t>(joints));
  }
  return hidden;
}

absl::Status CheckAnswer(const Method& method, const dataset::Sequence& sequence,
                         const std::vector<motion::Vec3>& answer) {
  const size_t wanted = sequence.pair.leader.positions.size();
  if (answer.size() != wanted) {
    return absl::InternalError(absl::StrCat(method.name(), ": ", sequence.id, ": ", answer.size(),
                                            " positions, wanted ", wanted));
  }
  if (std::all_of(answer.begin(), answer.end(), [](motion::Vec3 p) { return IsFinite(p); })) {
    return absl::OkStatus();
  }
  return absl::InternalError(
      absl::StrCat(method.name(), ": ", sequence.id, ": not finite, wanted finite positions"));
}

}  // namespace

absl::StatusOr<FoldResult> RunFold(const dataset::Dataset& dataset, const dataset::Split& split,
                                   const std::string& subject, Method* method) {
  FoldResult result;
  result.subject = subject;
  auto start = std::chrono::steady_clock::now();
  absl::Status status = method->Train(dataset, split.train);
  if (!status.ok()) return status;
  result.train_seconds = SecondsSince(start);
  start = std::chrono::steady_clock::now();
  for (const int i : split.test) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    metrics::ScoredMotion motion = {
        i, method->Predict(WithoutAnswer(sequence, dataset.skeleton.joint_count(),
                                         method->reads_first_pose()))};
    status = CheckAnswer(*method, sequence, motion.follower);
    if (!status.ok()) return status;
    result.motions.push_back(std::move(motion));
  }
  result.predict_seconds = SecondsSince(start);
  return result;
}

absl::StatusOr<std::vector<FoldResult>> RunLeaveOneSubjectOut(
    const dataset::Dataset& dataset, std::vector<std::string> subjects, Method* method,
    const std::function<void(const FoldResult&)>& done) {
  if (subjects.empty()) subjects = dataset.Subjects();
  if (subjects.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(dataset.name, ": no subjects, wanted sequences that name theirs"));
  }
  std::vector<FoldResult> folds;
  for (const std::string& subject : subjects) {
    absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
    if (!split.ok()) return split.status();
    absl::StatusOr<FoldResult> fold = RunFold(dataset, *split, subject, method);
    if (!fold.ok()) return fold.status();
    if (done) done(*fold);
    folds.push_back(*std::move(fold));
  }
  return folds;
}

std::vector<metrics::ScoredMotion> PoolMotions(const std::vector<FoldResult>& folds) {
  std::vector<metrics::ScoredMotion> motions;
  for (const FoldResult& fold : folds) {
    motions.insert(motions.end(), fold.motions.begin(), fold.motions.end());
  }
  return motions;
}

}  // namespace duet::evaluation::protocol
