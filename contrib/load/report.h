#ifndef DUET_CONTRIB_LOAD_REPORT_H_
#define DUET_CONTRIB_LOAD_REPORT_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "contrib/load/measurement.h"

namespace duet::contrib::load {

// A kind of call in a report.
struct KindName {
  std::string model;  // "sbu@2"
  int frames = 0;
  double share = 1;  // of all calls
};

// What every report begins with.
struct ReportHead {
  std::string title;
  std::string program;  // "duet-load 1.0.0"
  std::string time;     // start, in UTC
  std::string server;
  std::vector<std::pair<std::string, std::string>> settings;  // flags and their values
};

// The measurements of a server, step by step.
struct Report : ReportHead {
  std::vector<KindName> kinds;
  std::vector<Measurement> steps;
};

// "8 callers", "100 calls/s".
std::string StepName(const Step& step);
// "RESOURCE_EXHAUSTED"
std::string CodeName(absl::StatusCode code);
// Why the generator did not keep up; empty if it did.
std::string WhyNotKeptUp(const Measurement& measurement);
// "sbu@2, 46 frames".
std::string Describe(const KindName& kind);

// A table for people.
std::string ToText(const Report& report);
// Everything. Times in milliseconds.
std::string ToJson(const Report& report);
// A row for each step, under a header. Times in milliseconds.
std::string ToCsv(const Report& report);
// An HTML page that needs no other file: holds ToJson, and a script that draws tables and charts.
std::string ToPage(const Report& report);

// Lines of a CSV file with every call.
std::string RecordHeader();
std::string RecordLine(const Step& step, const KindName& kind, const CallRecord& record);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_REPORT_H_
