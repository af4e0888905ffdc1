#include "model/evaluation/protocol/protocol.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::evaluation::protocol {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The sequence without its follower, so that a method that reads the answer fails instead of
// scoring well.
dataset::Sequence WithoutAnswer(const dataset::Sequence& sequence, bool keep_first_pose) {
  dataset::Sequence hidden = sequence;
  motion::Clip& follower = hidden.pair.follower;
  follower.poses.Resize(keep_first_pose ? 1 : 0);
  return hidden;
}

absl::Status CheckAnswer(const dataset::Sequence& sequence, const motion::Poses& answer) {
  const motion::Clip& leader = sequence.pair.leader;
  if (answer.frame_count() != leader.frame_count() ||
      answer.joint_count() != leader.joint_count()) {
    return absl::InternalError(absl::StrCat(
        answer.frame_count(), " frames of ", answer.joint_count(), " joints came, wanted ",
        leader.frame_count(), " of ", leader.joint_count(), " as the leader has"));
  }
  const absl::Span<const motion::Vec3> all = answer.all();
  if (std::all_of(all.begin(), all.end(), [](motion::Vec3 p) { return IsFinite(p); })) {
    return absl::OkStatus();
  }
  return absl::InternalError("not finite, wanted finite positions");
}

absl::StatusOr<motion::Poses> Answer(const Method& method, const dataset::Sequence& sequence) {
  absl::StatusOr<motion::Poses> answer =
      method.Predict(WithoutAnswer(sequence, method.reads_first_pose()));
  const absl::Status status = answer.ok() ? CheckAnswer(sequence, *answer) : answer.status();
  if (status.ok()) return answer;
  return absl::Status(status.code(),
                      absl::StrCat(method.name(), ": ", sequence.id, ": ", status.message()));
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
    absl::StatusOr<motion::Poses> answer = Answer(*method, sequence);
    if (!answer.ok()) return answer.status();
    result.motions.push_back({i, *std::move(answer)});
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
