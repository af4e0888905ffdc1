#ifndef DUET_CONTRIB_LOAD_LIVE_CONTENT_H_
#define DUET_CONTRIB_LOAD_LIVE_CONTENT_H_

#include <vector>

#include "client/request.h"

namespace duet::contrib::load {

// What all sessions begin with.
struct LiveContent {
  client::ModelChoice model;
  std::vector<client::ClassWeight> labels;  // empty: 1 for the model's first class
  int delay_frames = 0;
  int plan_frames = 0;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_CONTENT_H_
