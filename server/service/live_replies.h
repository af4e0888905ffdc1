#ifndef DUET_SERVER_SERVICE_LIVE_REPLIES_H_
#define DUET_SERVER_SERVICE_LIVE_REPLIES_H_

#include <memory>

#include "absl/status/status.h"
#include "duet/v1/live.pb.h"
#include "model/engine/synthesis_options.h"
#include "model/engine/synthesizer.h"
#include "server/common/clock.h"
#include "server/service/call.h"
#include "server/service/live_session.h"
#include "server/service/reply_mapping.h"

namespace duet::server::service {

// Makes the replies of SynthesizeLive: header, then frames and notices, then summary. Parses the
// messages after the first one for its session.
//
// Model failures become INTERNAL without details; CallRecord::cause has the details for the log.
class LiveReplies final : public ReplySource {
 public:
  // `header`: without the request ID. `options.clean_up` is the resolved choice, not absent.
  // `clock` outlives the replies.
  LiveReplies(std::shared_ptr<LiveSession> session, v1::LiveHeader header,
              std::shared_ptr<const engine::Synthesizer> model, engine::SynthesisOptions options,
              const common::Clock& clock);

  absl::Status Start(SourceEvents events) override;
  NextReply Next(CallScope& scope) override;
  void Cancel() override { session_->Cancel(); }
  void Report(metrics::CallRecord& record) const override;
  void OnMessage(grpc::ByteBuffer bytes) override;
  void OnEndOfMessages() override { session_->OnEndOfMessages(); }
  void OnDraining() override { session_->OnDraining(); }

 private:
  // The status with which the call ends.
  static absl::Status ErrorOf(const LiveOutput& output, metrics::CallRecord& record);
  NextReply FramesReply(LiveOutput output, CallScope& scope);
  NextReply SummaryReply(const metrics::CallRecord& record);

  const std::shared_ptr<LiveSession> session_;
  const std::shared_ptr<const engine::Synthesizer> model_;
  const engine::SynthesisOptions options_;
  const common::Clock& clock_;
  v1::LiveHeader header_;
  bool sent_header_ = false, sent_summary_ = false;
  v1::SynthesizeLiveResponse reply_;  // the last one returned
};

// The header of a session that the model answers. `start`: valid.
v1::LiveHeader MakeLiveHeader(const engine::ModelDescription& model,
                              const ValidatedLiveStart& start);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_LIVE_REPLIES_H_
