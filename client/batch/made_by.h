#ifndef DUET_CLIENT_BATCH_MADE_BY_H_
#define DUET_CLIENT_BATCH_MADE_BY_H_

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "client/result.h"

namespace duet::client::batch {

// What decides the bits of an answer besides its request and the weights. Empty texts are unknown:
// earlier servers do not state them.
struct MadeBy {
  bool cleaned_up = false;
  std::string engine;
  std::string server_version;
  friend bool operator==(const MadeBy& a, const MadeBy& b) {
    return a.cleaned_up == b.cleaned_up && a.engine == b.engine &&
           a.server_version == b.server_version;
  }
};

MadeBy MadeByOf(const SynthesisResult& result);
// Absent for records of versions that did not store it, and of items without an answer.
std::optional<MadeBy> MadeByOf(const nlohmann::ordered_json& record);
void AddMadeBy(const MadeBy& made_by, nlohmann::ordered_json* record);

// How the answers of each model of a set were made, which must be the same for all of them.
//
// Threads: safe to call concurrently.
class Makers {
 public:
  // Stores how the first answer of a model, "name@version", was made. FAILED_PRECONDITION, with
  // what differs, if this one was made in another way.
  absl::Status Check(const std::string& model, const MadeBy& made_by);
  // The same for the answer of an item's record, if it has one.
  absl::Status CheckRecord(const nlohmann::ordered_json& record);

 private:
  std::mutex mutex_;
  std::map<std::string, MadeBy> first_;  // by model
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_MADE_BY_H_
