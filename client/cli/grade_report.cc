#include "client/cli/grade_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;

constexpr std::size_t kMostRunsShown = 5;

double Rounded(double share) { return std::round(share * 1e6) / 1e6; }

std::string Frames(const FrameRun& run) {
  const int last = run.first_frame + run.frame_count - 1;
  return last == run.first_frame ? absl::StrCat(last) : absl::StrCat(run.first_frame, "-", last);
}

std::string BadFrames(const std::vector<FrameRun>& runs) {
  const std::size_t shown = std::min(runs.size(), kMostRunsShown);
  std::vector<std::string> frames;
  for (std::size_t i = 0; i < shown; ++i) frames.push_back(Frames(runs[i]));
  return absl::StrCat(absl::StrJoin(frames, ", "), shown < runs.size() ? ", ..." : "");
}

// "< 1 %" if it would round to 0 %, which only a share of 0 is.
std::string Percent(double share) {
  return share > 0 && share < 0.005 ? "< 1 %" : absl::StrFormat("%.0f %%", 100 * share);
}

}  // namespace

std::string DescribeGrade(const MotionGrade& grade) {
  std::string text = absl::StrFormat(
      "          graded: twisted %s, both feet move %s (leader %s), overlapping %s\n",
      Percent(grade.twisted), Percent(grade.skating), Percent(grade.leader_skating),
      Percent(grade.overlapping));
  if (!grade.bad_runs.empty()) {
    absl::StrAppend(&text, "          twisted or overlapping in frames ", BadFrames(grade.bad_runs),
                    "\n");
  }
  return text;
}

json GradeJson(const MotionGrade& grade) {
  json runs = json::array();
  for (const FrameRun& run : grade.bad_runs) {
    runs.push_back({{"first_frame", run.first_frame}, {"frame_count", run.frame_count}});
  }
  return {{"twisted", Rounded(grade.twisted)},
          {"skating", Rounded(grade.skating)},
          {"leader_skating", Rounded(grade.leader_skating)},
          {"overlapping", Rounded(grade.overlapping)},
          {"bad_runs", runs}};
}

}  // namespace duet::client::cli
