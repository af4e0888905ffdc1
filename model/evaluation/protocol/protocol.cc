#include "model/evaluation/protocol/protocol.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"

namespace duet::evaluation::protocol {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The sequence without its follower, so that a method that reads the answer fails instead of
// scoring well.
dataset::Sequence WithoutAnswer(const dataset::Sequence& sequence, bool keep_first_pose) {
  dataset::Sequence hidden = sequence;
  hidden.pair.follower.poses.Resize(keep_first_pose ? 1 : 0);
  return hidden;
}

absl::Status CheckAnswer(const dataset::Sequence& sequence, const motion::Poses& answer) {
  const motion::Clip& leader = sequence.pair.leader;
  if (answer.frame_count() != leader.frame_count() ||
      answer.joint_count() != leader.joint_count()) {
    return absl::InternalError(absl::StrCat("answer: expected the leader's ", leader.frame_count(),
                                            " frames of ", leader.joint_count(), " joints, got ",
                                            answer.frame_count(), " of ", answer.joint_count()));
  }
  const absl::Span<const motion::Vec3> all = answer.all();
  if (std::all_of(all.begin(), all.end(), [](motion::Vec3 p) { return IsFinite(p); })) {
    return absl::OkStatus();
  }
  return absl::InternalError("answer: expected finite positions, got one that is not");
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
                                   Method* method) {
  FoldResult result;
  auto start = std::chrono::steady_clock::now();
  DUET_RETURN_IF_ERROR(method->Train(dataset, split.train));
  result.train_seconds = SecondsSince(start);
  start = std::chrono::steady_clock::now();
  for (const int i : split.test) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    DUET_TRY(motion::Poses answer, Answer(*method, sequence));
    result.motions.push_back({i, std::move(answer)});
  }
  result.predict_seconds = SecondsSince(start);
  return result;
}

}  // namespace duet::evaluation::protocol
