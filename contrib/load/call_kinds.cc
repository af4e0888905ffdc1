#include "contrib/load/call_kinds.h"

#include <cmath>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/internal/proto_conversion.h"

namespace duet::contrib::load {
namespace {

// Whether the server rejects a call of this kind because of its content.
absl::Status Try(const client::Client& client, const client::SynthesisRequest& request) {
  const auto enough = [](const client::FollowerChunk&) { return absl::CancelledError("enough"); };
  const absl::Status status = client.SynthesizeStreaming(request, enough).status();
  switch (status.code()) {
    case absl::StatusCode::kCancelled:
    case absl::StatusCode::kResourceExhausted:
    case absl::StatusCode::kDeadlineExceeded:
      return absl::OkStatus();
    default:
      return status;
  }
}

absl::StatusOr<CallKind> FindKind(const client::Client& client, const CallMix& mix,
                                  const client::ModelInfo& model, const client::ModelChoice& choice,
                                  int frames) {
  client::SynthesisRequest request;
  request.model = choice;
  request.leader = SwayingLeader(model, frames);
  request.weights = mix.labels;
  if (request.weights.empty()) request.weights = {{model.interaction_classes.front(), 1}};
  request.priority = mix.priority;
  const absl::StatusOr<v1::SynthesizeRequest> wire = client::internal::ToProto(request);
  if (!wire.ok()) return wire.status();
  absl::Status status = Try(client, request);
  if (!status.ok()) return status;
  CallKind kind;
  kind.model = absl::StrCat(model.name, "@", model.version);
  kind.frames = frames;
  kind.request = wire->SerializeAsString();
  return kind;
}

}  // namespace

motion::Clip SwayingLeader(const client::ModelInfo& model, int frames) {
  motion::Clip leader;
  leader.joint_names = model.joint_names;
  leader.frame_rate_hz = model.frame_rate_hz;
  const int joints = leader.joint_count();
  leader.poses = motion::Poses(frames, joints);
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < joints; ++j) {
      const float phase = 0.2F * static_cast<float>(t) + static_cast<float>(j);
      leader.at(t, j) = {0.2F * std::sin(phase), 0.1F * static_cast<float>(j),
                         0.2F * std::cos(phase)};
    }
  }
  return leader;
}

absl::StatusOr<std::vector<CallKind>> FindKinds(const client::Client& client, const CallMix& mix) {
  std::vector<CallKind> kinds;
  for (const Weighted<client::ModelChoice>& model : mix.models) {
    const absl::StatusOr<client::ModelDetails> details = client.GetModel(model.value);
    if (!details.ok()) return details.status();
    for (const Weighted<int>& frames : mix.frames) {
      absl::StatusOr<CallKind> kind =
          FindKind(client, mix, details->model, model.value, frames.value);
      if (!kind.ok()) return kind.status();
      kind->weight = model.weight * frames.weight;
      kinds.push_back(*std::move(kind));
    }
  }
  return kinds;
}

}  // namespace duet::contrib::load
