#include "model/retargeting/reading_report.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace duet::retargeting {

std::string DescribeParts(const std::vector<JointReading::Part>& parts) {
  if (parts.size() == 1 && parts[0].weight == 1) return parts[0].name;
  return absl::StrJoin(parts, " + ", [](std::string* out, const JointReading::Part& part) {
    absl::StrAppendFormat(out, "%.2f %s", static_cast<double>(part.weight), part.name);
  });
}

std::vector<std::string> JointNotes(const std::vector<JointReading>& joints) {
  std::vector<std::string> notes;
  for (const JointReading& joint : joints) {
    if (joint.origin != Origin::kGuessed) continue;
    notes.push_back(joint.parts.size() == 1
                        ? absl::StrCat(joint.joint, ": ", joint.parts[0].name, " (", joint.why, ")")
                        : absl::StrCat(joint.joint, ": ", joint.why));
  }
  return notes;
}

std::vector<std::string> ReadingReport::Notes() const {
  std::vector<std::string> notes = JointNotes(joints);
  for (const auto& [name, setting] : {std::pair("unit", &unit), std::pair("up axis", &up_axis),
                                      std::pair("frame rate", &frame_rate)}) {
    // A person who stands along y needs no explanation.
    if (!setting->has_value() || (*setting)->origin != Origin::kGuessed) continue;
    if ((*setting)->value == "y-up") continue;
    notes.push_back(absl::StrCat(name, ": ", (*setting)->value, " (", (*setting)->why, ")"));
  }
  notes.insert(notes.end(), remarks.begin(), remarks.end());
  return notes;
}

}  // namespace duet::retargeting
