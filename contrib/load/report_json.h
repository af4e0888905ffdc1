#ifndef DUET_CONTRIB_LOAD_REPORT_JSON_H_
#define DUET_CONTRIB_LOAD_REPORT_JSON_H_

#include <nlohmann/json.hpp>
#include <string>

#include "contrib/load/log_histogram.h"
#include "contrib/load/report.h"

namespace duet::contrib::load {

// What the JSON of all reports shares.
using Json = nlohmann::ordered_json;

Json ToJson(const ReportHead& head);
// Count, mean and percentiles, in a unit of figures.h.
Json Distribution(const LogHistogram& histogram, double unit);
// The whole distribution, [percentile, milliseconds] each: twenty steps for each tenfold fewer
// values beyond the percentile, to the largest.
Json Percentiles(const LogHistogram& histogram);
std::string Dump(const Json& json);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_REPORT_JSON_H_
