#ifndef DUET_CLIENT_INTERNAL_REPLY_ASSEMBLER_H_
#define DUET_CLIENT_INTERNAL_REPLY_ASSEMBLER_H_

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "client/result.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/clip.h"

namespace duet::client::internal {

// Checks a response stream message by message and gathers the follower.
//
// A call whose stream broke is run again from its first frame: StartStream begins each stream, and
// frames that an earlier one handed to the callback are not handed out twice.
//
// Errors:  INTERNAL when a message breaks the contract (order, counts, frames, finiteness, echo of
//          the leader's joints, rate, unit and axis); UNAVAILABLE when the stream merely ended
//          early; the callback's own status.
class ReplyAssembler {
 public:
  // `leader` and `on_chunk` outlive the assembler; `on_chunk` may be empty.
  ReplyAssembler(const motion::Clip& leader, const ChunkCallback& on_chunk)
      : leader_(leader), on_chunk_(on_chunk) {}

  void StartStream();
  absl::Status Accept(const v1::SynthesizeResponse& response);
  // Whether the reply is whole, after the stream ended with the status `transport`.
  absl::Status EndStream(const absl::Status& transport) const;

  // Frames that the callback has seen, over all streams.
  int handed_out() const { return handed_out_; }
  // What the callback said last; not OK when it ended the call.
  const absl::Status& callback_status() const { return callback_status_; }
  bool has_frames() const { return received_ > 0; }
  const std::optional<v1::SynthesisHeader>& header() const { return header_; }

  // The gathered reply, after EndStream returned OK; timings and attempts are the caller's to fill.
  SynthesisResult TakeResult() &&;

 private:
  absl::Status AcceptHeader(const v1::SynthesisHeader& header);
  absl::Status AcceptChunk(const v1::MotionChunk& chunk);
  absl::Status CheckChunk(const v1::MotionChunk& chunk) const;
  absl::Status AcceptSummary(const v1::SynthesisSummary& summary);
  absl::Status HandOut();

  const motion::Clip& leader_;
  const ChunkCallback& on_chunk_;
  std::optional<v1::SynthesisHeader> header_;
  std::optional<v1::SynthesisSummary> summary_;
  motion::Poses follower_;  // [received_, joints] of the stream in progress
  int received_ = 0;
  int chunk_count_ = 0;
  int handed_out_ = 0;
  absl::Status callback_status_;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_REPLY_ASSEMBLER_H_
