#ifndef DUET_SERVER_SERVICE_LIVE_INBOX_H_
#define DUET_SERVER_SERVICE_LIVE_INBOX_H_

#include <grpcpp/support/byte_buffer.h>

#include <memory>
#include <utility>

#include "server/service/live_session.h"
#include "server/service/reception.h"

namespace duet::server::service {

// Parses the messages of a live session after the first one, and passes them to the session.
class LiveInbox final : public MessageSink {
 public:
  explicit LiveInbox(std::shared_ptr<LiveSession> session) : session_(std::move(session)) {}

  void OnMessage(grpc::ByteBuffer bytes) override;
  void OnEndOfMessages() override { session_->OnEndOfMessages(); }
  void OnDraining() override { session_->OnDraining(); }
  bool OwesAnswers() const override { return session_->OwesAnswers(); }

 private:
  const std::shared_ptr<LiveSession> session_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_LIVE_INBOX_H_
