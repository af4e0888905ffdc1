#ifndef DUET_TESTS_ENGINE_RULE_NETWORK_H_
#define DUET_TESTS_ENGINE_RULE_NETWORK_H_

#include <functional>
#include <utility>
#include <vector>

#include "model/engine/network.h"

namespace duet::engine {

using Inputs = absl::Span<const NetworkInput>;
using Answer = absl::StatusOr<std::vector<motion::Poses>>;

// A network that answers by a rule.
class RuleNetwork : public Network {
 public:
  explicit RuleNetwork(std::function<Answer(Inputs)> rule) : rule_(std::move(rule)) {}
  Answer Run(Inputs inputs) const override { return rule_(inputs); }

 private:
  std::function<Answer(Inputs)> rule_;
};

}  // namespace duet::engine

#endif  // DUET_TESTS_ENGINE_RULE_NETWORK_H_
