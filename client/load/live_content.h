#ifndef DUET_CLIENT_LOAD_LIVE_CONTENT_H_
#define DUET_CLIENT_LOAD_LIVE_CONTENT_H_

#include <vector>

#include "client/request.h"

namespace duet::client::load {

// What all sessions begin with.
struct LiveContent {
  ModelChoice model;
  std::vector<ClassWeight> labels;  // empty: 1 for the model's first class
  int delay_frames = 0;
  int plan_frames = 0;
};

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_LIVE_CONTENT_H_
