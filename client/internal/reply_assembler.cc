#include "client/internal/reply_assembler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/internal/grpc_status.h"
#include "client/internal/proto_conversion.h"

namespace duet::client::internal {
namespace {

template <typename... Parts>
absl::Status Malformed(const Parts&... parts) {
  return absl::InternalError(absl::StrCat("the server's reply is malformed: ", parts...));
}

}  // namespace

void ReplyAssembler::StartStream() {
  header_.reset();
  summary_.reset();
  follower_ = motion::Poses(0, leader_.joint_count());
  rotations_ = {};
  received_ = 0;
  chunk_count_ = 0;
}

absl::Status ReplyAssembler::Accept(const v1::SynthesizeResponse& response) {
  if (summary_.has_value()) return Malformed("a message after the summary");
  switch (response.payload_case()) {
    case v1::SynthesizeResponse::kHeader:
      return AcceptHeader(response.header());
    case v1::SynthesizeResponse::kChunk:
      return AcceptChunk(response.chunk());
    case v1::SynthesizeResponse::kSummary:
      return AcceptSummary(response.summary());
    case v1::SynthesizeResponse::PAYLOAD_NOT_SET:
      return Malformed("a message without a payload");
  }
  return Malformed("a payload of an unknown kind");
}

absl::Status ReplyAssembler::AcceptHeader(const v1::SynthesisHeader& header) {
  if (header_.has_value()) return Malformed("a second header");
  const absl::Status echo = CheckHeader(header, leader_.joint_names, leader_.frame_rate_hz);
  if (!echo.ok()) return Malformed(echo.message());
  if (header.frame_count() != static_cast<uint32_t>(leader_.frame_count())) {
    return Malformed("header.frame_count: expected the leader's ", leader_.frame_count(), ", got ",
                     header.frame_count());
  }
  if (wants_rotations_ == header.rig().empty()) {
    return Malformed("header.rig: expected ",
                     wants_rotations_ ? "joints for the rotations that the request asks for, got "
                                        "none; does the server know reply_rotations?"
                                      : "none without reply_rotations, got joints");
  }
  absl::StatusOr<std::vector<motion::RestJoint>> rig =
      ReadRig("header.rig", header.rig(), leader_.joint_count());
  if (!rig.ok()) return Malformed(rig.status().message());
  rotations_.rig = *std::move(rig);
  header_ = header;
  return absl::OkStatus();
}

absl::Status ReplyAssembler::CheckChunk(const v1::MotionChunk& chunk) const {
  if (!header_.has_value()) return Malformed("a chunk before the header");
  if (chunk.first_frame() != static_cast<uint32_t>(received_)) {
    return Malformed("chunk.first_frame: expected ", received_, ", got ", chunk.first_frame());
  }
  const int left = leader_.frame_count() - received_;
  if (chunk.frame_count() < 1 || chunk.frame_count() > static_cast<uint32_t>(left)) {
    return Malformed("chunk.frame_count: expected 1 to ", left, ", got ", chunk.frame_count());
  }
  const size_t wanted = size_t{chunk.frame_count()} * leader_.joint_names.size() * 3;
  if (static_cast<size_t>(chunk.positions_size()) != wanted) {
    return Malformed("chunk.positions: expected ", wanted, " values for ", chunk.frame_count(),
                     " frames, got ", chunk.positions_size());
  }
  for (int i = 0; i < chunk.positions_size(); ++i) {
    if (!std::isfinite(chunk.positions(i))) {
      return Malformed("chunk.positions[", i, "] is not finite, in the chunk of frame ",
                       chunk.first_frame());
    }
  }
  absl::Status status = CheckRotations("chunk.rotations", chunk.rotations(), chunk.frame_count(),
                                       rotations_.rig.size());
  if (!status.ok()) {
    return Malformed(status.message(), ", in the chunk of frame ", chunk.first_frame());
  }
  return absl::OkStatus();
}

absl::Status ReplyAssembler::AcceptChunk(const v1::MotionChunk& chunk) {
  absl::Status status = CheckChunk(chunk);
  if (!status.ok()) return status;
  const motion::Poses frames(leader_.joint_count(), ToPoints(chunk.positions()));
  follower_.Append(frames.all());
  AppendRotations(chunk.rotations(), &rotations_.rotations);
  received_ += frames.frame_count();
  ++chunk_count_;
  return HandOut();
}

absl::Status ReplyAssembler::HandOut() {
  if (!on_chunk_ || received_ <= handed_out_) return absl::OkStatus();
  FollowerChunk chunk{handed_out_, motion::Poses(0, leader_.joint_count()),
                      RotationsFrom(handed_out_)};
  chunk.poses.Append(follower_.frames(handed_out_, received_ - handed_out_));
  handed_out_ = received_;
  callback_status_ = on_chunk_(chunk);
  return callback_status_;
}

std::optional<motion::JointRotations> ReplyAssembler::RotationsFrom(int first) const {
  if (rotations_.rig.empty()) return std::nullopt;
  const auto begin =
      rotations_.rotations.begin() + first * static_cast<std::ptrdiff_t>(rotations_.rig.size());
  return motion::JointRotations{rotations_.rig, {begin, rotations_.rotations.end()}};
}

absl::Status ReplyAssembler::AcceptSummary(const v1::SynthesisSummary& summary) {
  if (!header_.has_value()) return Malformed("a summary before the header");
  if (received_ != leader_.frame_count()) {
    return Malformed("a summary after ", received_, " of ", leader_.frame_count(), " frames");
  }
  if (summary.frame_count() != static_cast<uint32_t>(received_)) {
    return Malformed("summary.frame_count: expected ", received_, ", got ", summary.frame_count());
  }
  if (summary.chunk_count() != static_cast<uint32_t>(chunk_count_)) {
    return Malformed("summary.chunk_count: expected ", chunk_count_, ", got ",
                     summary.chunk_count());
  }
  if (summary.constraint_metres_size() != constraints_) {
    return Malformed("summary.constraint_metres: expected ", constraints_,
                     " values, one for each of constraints, got ", summary.constraint_metres_size(),
                     "; does the server know constraints?");
  }
  summary_ = summary;
  return absl::OkStatus();
}

absl::Status ReplyAssembler::EndStream(const absl::Status& transport) const {
  if (!transport.ok() && !IsBrokenConnection(transport)) return transport;
  if (summary_.has_value())
    return absl::OkStatus();  // the reply was complete before the connection broke
  if (!transport.ok() && !header_.has_value()) return transport;
  absl::Status broken = absl::UnavailableError(absl::StrCat(
      "the reply ended without a summary, after ", received_, " of ", leader_.frame_count(),
      " frames", transport.ok() ? "" : ": ", transport.message()));
  return WithPayloadsOf(transport, std::move(broken));
}

SynthesisResult ReplyAssembler::TakeResult() && {
  SynthesisResult result;
  result.pair.leader = leader_;
  result.pair.follower.joint_names = leader_.joint_names;
  result.pair.follower.frame_rate_hz = leader_.frame_rate_hz;
  result.pair.follower.poses = std::move(follower_);
  ReadHeader(*header_, &result);
  result.engine = header_->engine();
  result.server_version = header_->server_version();
  if (summary_->has_unfamiliarity()) result.unfamiliarity = summary_->unfamiliarity();
  if (summary_->has_grade()) result.grade = FromProto(summary_->grade());
  result.constraint_metres = {summary_->constraint_metres().begin(),
                              summary_->constraint_metres().end()};
  if (!rotations_.rig.empty()) result.rotations = std::move(rotations_);
  result.window_count = static_cast<int>(summary_->window_count());
  result.timings.queue = absl::Seconds(summary_->queue_seconds());
  result.timings.compute = absl::Seconds(summary_->compute_seconds());
  return result;
}

}  // namespace duet::client::internal
