#ifndef DUET_CLIENT_CLI_INSPECTION_H_
#define DUET_CLIENT_CLI_INSPECTION_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/analysis/skeleton_check.h"
#include "client/cli/style.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/motion/vertical.h"
#include "model/retargeting/reading_report.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// One person of a file.
struct InspectedPerson {
  retargeting::ReadingReport report;
  motion::Clip clip;  // at 0 Hz where no rate is known
  std::vector<analysis::Check> checks;
};

// What there is to tell of a file. Where it cannot be read, `status` says why, and the one person
// has what was understood up to there.
struct Inspection {
  std::string file;
  absl::Status status;
  std::vector<InspectedPerson> people;
  // Of the camera, from all people. Absent if the file cannot be read or has no frame rate.
  std::optional<motion::VerticalEstimate> vertical;
};

// For people, and for programs.
std::string DescribeInspection(const Inspection& inspection, const Style& style);
nlohmann::json InspectionJson(const Inspection& inspection);

// The same for the camera's vertical, also of several files together.
std::string DescribeVertical(const motion::VerticalEstimate& vertical);
nlohmann::json VerticalJson(const motion::VerticalEstimate& vertical);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_INSPECTION_H_
