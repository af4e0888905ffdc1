#ifndef DUET_CLIENT_LOAD_LIVE_REPORT_H_
#define DUET_CLIENT_LOAD_LIVE_REPORT_H_

#include <string>
#include <vector>

#include "client/load/live_measurement.h"
#include "client/load/report.h"

namespace duet::client::load {

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

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_LIVE_REPORT_H_
