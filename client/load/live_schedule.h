#ifndef DUET_CLIENT_LOAD_LIVE_SCHEDULE_H_
#define DUET_CLIENT_LOAD_LIVE_SCHEDULE_H_

#include <optional>

#include "client/load/live_options.h"
#include "client/load/time.h"
#include "model/base/random.h"

namespace duet::client::load {

// When a session sends its leader frames, independent of the answers.
class LiveSchedule {
 public:
  // `begin`: of the run. The same options and session give the same times.
  LiveSchedule(const LiveOptions& options, int session, Time begin);

  // When the session opens. Sessions open one after another within a second.
  Time opens() const { return opens_; }

  // A frame: when it is due to be sent, unless it is lost.
  struct Frame {
    int index = 0;
    Time due;
    bool lost = false;
  };
  // The next frame, in the order of indices and of times. The first is never lost.
  Frame Next();

 private:
  Time DueOf(int frame) const;

  const LiveOptions& options_;
  Time opens_;
  Time stalls_from_, stalls_until_;
  base::Random random_;
  int next_ = 0;
  Time last_due_;
};

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_LIVE_SCHEDULE_H_
