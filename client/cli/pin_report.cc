#include "client/cli/pin_report.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace duet::client::cli {
namespace {

using nlohmann::json;

// A pin that is nearer than this is reported as reached.
constexpr float kReachedMetres = 0.01f;

}  // namespace

std::string DescribePins(const std::vector<JointConstraint>& pins,
                         const std::vector<float>& metres) {
  std::vector<std::string> parts;
  std::size_t reached = 0;
  for (std::size_t i = 0; i < std::min(pins.size(), metres.size()); ++i) {
    if (metres[i] < kReachedMetres) {
      ++reached;
    } else {
      parts.push_back(absl::StrFormat("%s in frame %d is %.1f cm away", pins[i].joint,
                                      pins[i].frame, 100 * double{metres[i]}));
    }
  }
  if (reached > 0) parts.insert(parts.begin(), absl::StrCat(reached, " reached"));
  if (parts.empty()) return "";
  return absl::StrCat("          pins: ", absl::StrJoin(parts, ", "), "\n");
}

json PinsJson(const std::vector<JointConstraint>& pins, const std::vector<float>& metres) {
  json list = json::array();
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const JointConstraint& pin = pins[i];
    list.push_back({{"joint_name", pin.joint},
                    {"frame", pin.frame},
                    {"position", {pin.position.x, pin.position.y, pin.position.z}},
                    {"softness", pin.softness}});
    if (i < metres.size()) list.back()["remaining_metres"] = metres[i];
  }
  return list;
}

}  // namespace duet::client::cli
