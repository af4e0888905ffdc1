#ifndef DUET_SERVER_SERVICE_CLIP_REPLIES_H_
#define DUET_SERVER_SERVICE_CLIP_REPLIES_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "duet/v1/synthesis.pb.h"
#include "model/engine/synthesizer.h"
#include "server/batching/window_scheduler.h"
#include "server/service/call.h"
#include "server/service/clip_stream.h"
#include "server/service/reply_mapping.h"
#include "server/service/validator.h"

namespace duet::server::service {

// What decides the bits of a reply besides request and weights (SynthesisHeader).
struct ServerBuild {
  std::string engine;
  std::string version;
};

// The replies of Synthesize: header, chunks and summary of one clip.
//
// With rotations, the header follows once the first frames exist, because its rig has their bone
// lengths.
//
// Chunks hold at most request.chunk_frames frames. Model failures become INTERNAL without details;
// CallRecord::cause has the details for the log.
class ClipReplies final : public ReplySource {
 public:
  // `scheduler` must outlive every window that it is given. Requires request.clip.options.clean_up
  // to be set. Uses the priority of the request and ignores options.priority.
  ClipReplies(std::shared_ptr<const engine::Synthesizer> model, ValidatedRequest request,
              ClipStreamOptions options, batching::WindowScheduler& scheduler,
              ServerBuild build = {});

  absl::Status Start(SourceEvents events) override;
  NextReply Next(CallScope& scope) override;
  void Cancel() override { stream_->Cancel(); }
  void Report(metrics::CallRecord& record) const override;

 private:
  enum class Part { kHeader, kFrames, kEnd };

  NextReply NextHeader(CallScope& scope);
  NextReply NextFrames(CallScope& scope);
  void FillHeader(const metrics::CallRecord& record);
  void FillChunk(ClipPart part, CallScope& scope);
  void FillSummary(const metrics::CallRecord& record);
  // Number of samples that the model draws for each window.
  int Candidates() const;

  const std::shared_ptr<const engine::Synthesizer> model_;
  const engine::SynthesisOptions options_;
  const batching::Priority priority_;
  const ReplyMapping mapping_;
  const int chunk_frames_;
  const ServerBuild build_;
  // Shared with the stream, whose last window may outlive this. Set before the first window starts.
  const std::shared_ptr<std::function<void()>> on_progress_;
  const std::shared_ptr<ClipStream> stream_;
  // With rotations, made from the first part, which waits here while the header is sent.
  std::unique_ptr<ReplyRig> rig_;
  ClipPart first_part_;
  Part next_ = Part::kHeader;
  v1::SynthesizeResponse reply_;  // the last one returned
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CLIP_REPLIES_H_
