#ifndef DUET_CLIENT_CLI_PIN_REPORT_H_
#define DUET_CLIENT_CLI_PIN_REPORT_H_

#include <string>
#include <vector>

#include "client/request.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {

// One line, such as "pins: 2 reached, right_hand in frame 40 is 12.3 cm away"; empty without pins.
// `metres`: SynthesisResult::constraint_metres.
std::string DescribePins(const std::vector<JointConstraint>& pins,
                         const std::vector<float>& metres);

// The fields have the names of duet.v1.JointConstraint; remaining_metres is what remains.
nlohmann::json PinsJson(const std::vector<JointConstraint>& pins, const std::vector<float>& metres);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_PIN_REPORT_H_
