#ifndef DUET_CONTRIB_LOAD_CALL_KINDS_H_
#define DUET_CONTRIB_LOAD_CALL_KINDS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/client.h"
#include "client/request.h"
#include "client/result.h"
#include "model/motion/clip.h"

namespace duet::contrib::load {

// How often one of several is drawn, against the others.
template <typename T>
struct Weighted {
  T value;
  double weight = 1;
};

// The requested clips: every model with every length.
struct CallMix {
  std::vector<Weighted<client::ModelChoice>> models = {{client::ModelChoice(), 1}};
  std::vector<Weighted<int>> frames = {{46, 1}};  // of leaders at the model's own rate
  std::vector<client::ClassWeight> labels;        // empty: 1 for the first class of each model
  client::Priority priority = client::Priority::kInteractive;
};

// Calls with the same request.
struct CallKind {
  std::string model;  // "sbu@2"
  int frames = 0;
  double weight = 1;
  std::string request;  // a serialised duet.v1.SynthesizeRequest
};

// A leader of `frames` frames: a figure that sways, in the model's joints, at its rate.
motion::Clip SwayingLeader(const client::ModelInfo& model, int frames);

// Resolves the models at the server, and tries a call of each kind, so that rejections are known
// before measuring. The leader is generated: a figure that sways, in the model's joints. Its motion
// does not affect the cost.
//
// Errors: the server's status, except rejections for lack of capacity.
absl::StatusOr<std::vector<CallKind>> FindKinds(const client::Client& client, const CallMix& mix);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_CALL_KINDS_H_
