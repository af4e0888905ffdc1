#ifndef DUET_CLIENT_INTERNAL_REPLY_ASSEMBLER_H_
#define DUET_CLIENT_INTERNAL_REPLY_ASSEMBLER_H_

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "client/result.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/clip.h"

namespace duet::client::internal {

// Validates a response stream message by message and assembles the follower.
//
// A broken stream is repeated from its first frame. StartStream begins each stream; frames that an
// earlier stream passed to the callback are not passed again.
//
// Errors:  INTERNAL if a message violates the contract (order, counts, frames, finiteness, echo of
//          the leader's joints, rate, unit and axis); UNAVAILABLE if the stream ended early; the
//          callback's own status.
class ReplyAssembler {
 public:
  // `leader` and `on_chunk` outlive the assembler; `on_chunk` may be empty. `rotations`: whether
  // the request asks for them. `constraints`: how many it has.
  ReplyAssembler(const motion::Clip& leader, const ChunkCallback& on_chunk, bool rotations = false,
                 int constraints = 0)
      : leader_(leader),
        on_chunk_(on_chunk),
        wants_rotations_(rotations),
        constraints_(constraints) {}

  void StartStream();
  absl::Status Accept(const v1::SynthesizeResponse& response);
  // Returns OK if the reply is complete. `transport`: the final status of the stream.
  absl::Status EndStream(const absl::Status& transport) const;

  // Number of frames passed to the callback, over all streams.
  int handed_out() const { return handed_out_; }
  // The last status that the callback returned. An error ended the call.
  const absl::Status& callback_status() const { return callback_status_; }
  bool has_frames() const { return received_ > 0; }
  const std::optional<v1::SynthesisHeader>& header() const { return header_; }

  // Returns the assembled reply. Requires EndStream to have returned OK. The caller fills in
  // timings and attempts.
  SynthesisResult TakeResult() &&;

 private:
  absl::Status AcceptHeader(const v1::SynthesisHeader& header);
  absl::Status AcceptChunk(const v1::MotionChunk& chunk);
  absl::Status CheckChunk(const v1::MotionChunk& chunk) const;
  // Of the frames from `first` on that have been received. Absent without a rig.
  std::optional<motion::JointRotations> RotationsFrom(int first) const;
  absl::Status AcceptSummary(const v1::SynthesisSummary& summary);
  absl::Status HandOut();

  const motion::Clip& leader_;
  const ChunkCallback& on_chunk_;
  const bool wants_rotations_;
  const int constraints_;
  std::optional<v1::SynthesisHeader> header_;
  std::optional<v1::SynthesisSummary> summary_;
  motion::Poses follower_;            // [received_, joints] of the stream in progress
  motion::JointRotations rotations_;  // of these frames
  int received_ = 0;
  int chunk_count_ = 0;
  int handed_out_ = 0;
  absl::Status callback_status_;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_REPLY_ASSEMBLER_H_
