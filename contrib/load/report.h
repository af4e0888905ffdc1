#ifndef DUET_CONTRIB_LOAD_REPORT_H_
#define DUET_CONTRIB_LOAD_REPORT_H_

#include <string>
#include <vector>

#include "contrib/load/calls.h"
#include "contrib/load/live.h"

namespace duet::contrib::load {

// The measurements of a server, step by step: either of calls or of live sessions.
struct Report {
  std::string program;  // "duet-load 1.0.0"
  std::string time;     // start, in UTC
  std::string server;
  std::string model;  // "sbu@3"
  std::vector<CallFigures> calls;
  std::vector<LiveFigures> live;
};

// "8 callers", "100 calls/s", "20 sessions".
std::string StepName(const CallLoad& load);
std::string StepName(const LiveFigures& step);

// Whether any call or frame was answered.
bool IsAnswered(const Report& report);

// A table for people.
std::string ToText(const Report& report);
// Everything. Times in milliseconds.
std::string ToJson(const Report& report);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_REPORT_H_
