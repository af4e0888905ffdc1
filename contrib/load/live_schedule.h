#ifndef DUET_CONTRIB_LOAD_LIVE_SCHEDULE_H_
#define DUET_CONTRIB_LOAD_LIVE_SCHEDULE_H_

#include <optional>

#include "contrib/load/live_options.h"
#include "contrib/load/time.h"
#include "model/base/random.h"

namespace duet::contrib::load {

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

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_SCHEDULE_H_
