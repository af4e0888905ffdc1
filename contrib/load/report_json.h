#ifndef DUET_CONTRIB_LOAD_REPORT_JSON_H_
#define DUET_CONTRIB_LOAD_REPORT_JSON_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "contrib/load/log_histogram.h"
#include "contrib/load/report.h"

namespace duet::contrib::load {

// Counted units per reported unit.
inline constexpr double kMillisecond = 1e6;  // nanoseconds
inline constexpr double kHertz = 1e3;        // millihertz

inline double In(double unit, int64_t value) { return static_cast<double>(value) / unit; }

// What the JSON of all reports shares.
using Json = nlohmann::ordered_json;

Json ToJson(const ReportHead& head);
// Count, mean and percentiles, in one of these units.
Json Distribution(const LogHistogram& histogram, double unit);
// The whole distribution, [percentile, milliseconds] each: twenty steps for each tenfold fewer
// values beyond the percentile, to the largest.
Json Percentiles(const LogHistogram& histogram);
std::string Dump(const Json& json);

// The HTML page that draws a report's JSON.
std::string PageOf(const std::string& json);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_REPORT_JSON_H_
