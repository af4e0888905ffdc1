#ifndef DUET_CONTRIB_LOAD_LIVE_REPORT_H_
#define DUET_CONTRIB_LOAD_LIVE_REPORT_H_

#include <string>
#include <vector>

#include "contrib/load/live_measurement.h"
#include "contrib/load/report.h"

namespace duet::contrib::load {

// The measurements of live sessions, step by step.
struct LiveReport : ReportHead {
  std::string model;  // "sbu@2"
  int delay_frames = 0;
  std::vector<LiveMeasurement> steps;
};

// "20 sessions".
std::string StepName(const LiveMeasurement& step);

// As ToText, ToJson and ToPage of report.h.
std::string ToText(const LiveReport& report);
std::string ToJson(const LiveReport& report);
std::string ToPage(const LiveReport& report);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_REPORT_H_
