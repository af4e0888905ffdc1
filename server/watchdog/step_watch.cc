#include "server/watchdog/step_watch.h"

namespace duet::server::watchdog {

void StepWatch::Look(const common::ThreadStates& threads, double elapsed) {
  for (std::size_t i = 0; i < threads.size(); ++i) {
    const common::ThreadState& now = threads[i];
    Watched& thread = watched_[i];
    const bool same = now.thread_id == thread.busy.thread_id && now.beat == thread.beat &&
                      now.step == thread.busy.step && now.step != nullptr;
    thread.busy = {now.thread_id, now.step, same ? thread.busy.seconds + elapsed : 0};
    thread.beat = now.beat;
  }
}

BusyThread StepWatch::longest() const {
  BusyThread longest;
  ForEach(0, /*every=*/false, [&longest](const BusyThread& thread) {
    if (longest.step == nullptr || thread.seconds > longest.seconds) longest = thread;
  });
  return longest;
}

}  // namespace duet::server::watchdog
