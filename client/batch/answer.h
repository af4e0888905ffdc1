#ifndef DUET_CLIENT_BATCH_ANSWER_H_
#define DUET_CLIENT_BATCH_ANSWER_H_

#include <string>

#include "absl/status/status.h"
#include "client/batch/flow/server_choice.h"
#include "client/batch/loaded_leader.h"
#include "client/batch/plan.h"
#include "client/batch/record.h"
#include "client/request.h"
#include "client/result.h"

namespace duet::client::batch {

// What a call's status means for its item.
enum class Meaning {
  kAnswer,    // a follower came
  kWait,      // the server is full or away: the item is asked for again when it is not
  kTryAgain,  // a passing failure of this call
  kRefused,   // the item will always be refused
  kStop,      // every item would be: credentials, or a model that is gone
};
Meaning MeaningOf(const absl::Status& status);
flow::CallEnd CallEndOf(const absl::Status& status);

// The request of an item. `retry`: which seed, 0 the first.
SynthesisRequest ToRequest(const Item& item, const Recipe& recipe, const ModelInfo& model,
                           const LoadedLeader& leader, int retry);

// The call's name in the server's log: the same whenever the item is asked for.
std::string RequestId(const Item& item, int retry);

// The index entry of an answer, whose pair is at the output's rate.
RecordedAnswer ToRecorded(const Item& item, const QualityFilter& filter,
                          const SynthesisResult& result, const LoadedLeader& leader,
                          const motion::Skeleton& skeleton, int retry);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ANSWER_H_
