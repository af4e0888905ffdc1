#ifndef DUET_SERVER_SERVICE_RECEPTION_H_
#define DUET_SERVER_SERVICE_RECEPTION_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/service/admission.h"
#include "server/service/call_scope.h"
#include "server/service/live_calls.h"
#include "server/service/share_pool.h"
#include "server/service/synthesis_call.h"

namespace duet::server::service {

// How long a request may take to arrive.
struct ReceptionLimits {
  // Until then it is on its way like any other. What takes longer needs leave to arrive slowly
  // (Admission): whoever sends slowly, or much, holds memory meanwhile.
  double slow_seconds = 0.1;
  double timeout_seconds = 30;
};

// One call from its headers to its answer: waits for the message, and hands the call on when it has
// come. Whoever ends it first (the message that comes, the caller that goes away, a time limit, the
// server's shutdown) decides; the others find it ended.
//
// The writer is used only by whom that is, so that it may be destroyed once it was told to finish.
//
// Threads: safe to call concurrently.
class Reception final : public LiveCall {
 public:
  struct Parts {
    ReplyWriter* writer = nullptr;  // lives until it was told to finish
    Admission* admission = nullptr;
    const common::Clock* clock = nullptr;
    ReceptionLimits limits;
    std::unique_ptr<CallScope> scope;
    std::string client;
    ShareLease place;  // empty for a method whose calls are not limited in number
  };
  explicit Reception(Parts parts);

  // The message has come. False when the call was ended meanwhile: nobody answers it. Otherwise
  // whoever called answers: with Refuse, Answer or GoOn.
  bool Received();
  // There will be no message.
  void Lost(bool cancelled);

  // Why the call is to end, where that came up while its message is handled: whoever handles it may
  // as well refuse it with this.
  std::optional<absl::Status> ended_meanwhile() const;
  // The first step that the request does not pass. The scope is the reception's until GoOn.
  void Refuse(const absl::Status& reason);
  // Ends the call as answered: its scope, to be closed by the caller.
  std::unique_ptr<CallScope> Answer();
  // Takes frames of the caller's share. RESOURCE_EXHAUSTED when it has not so many left.
  absl::Status HoldFrames(int frames) { return parts_.scope->HoldFrames(frames); }
  // What a call that goes on is made of.
  std::unique_ptr<CallScope> TakeScope();
  ShareLease TakePlace();
  // Starts the call. Reasons to end it go there from now on.
  void GoOn(std::shared_ptr<SynthesisCall> call);

  const std::string& client() const override { return parts_.client; }

  void Abort(const absl::Status& reason) override;
  void CheckTime(common::TimePoint now) override;
  std::optional<common::TimePoint> waiting_since() const override;
  std::optional<std::size_t> GiveUpReader(common::TimePoint now, double seconds) override;

 private:
  enum class State { kReceiving, kHandling, kAnswering, kEnded };

  // The call that is being answered; null before.
  std::shared_ptr<SynthesisCall> call() const;
  // Ends the call with its scope taken out, if it is in this state.
  bool EndFrom(State state, const absl::Status& reason);
  absl::Status LeaveToArrive(double waited) DUET_REQUIRES(mutex_);

  mutable common::Mutex mutex_;
  State state_ DUET_GUARDED_BY(mutex_) = State::kReceiving;
  Parts parts_;  // scope and place: of who moved the state on
  const common::TimePoint begin_;
  ShareLease slow_ DUET_GUARDED_BY(mutex_);  // leave to arrive slowly, once it was needed
  std::shared_ptr<SynthesisCall> call_ DUET_GUARDED_BY(mutex_);
  std::optional<absl::Status> end_ DUET_GUARDED_BY(mutex_);  // came while handling
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_RECEPTION_H_
