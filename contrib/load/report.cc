#include "contrib/load/report.h"

#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "contrib/load/report_json.h"
#include "model/base/counted.h"
#include "model/base/text.h"

namespace duet::contrib::load {
namespace {

std::string Quoted(const std::string& cell) { return absl::StrCat("\"", cell, "\""); }

std::string Fixed(double value, int decimals) {
  std::string text;
  base::AppendFixed(&text, value, decimals);
  return text;
}

void AppendPercentileNames(const std::string& figure, std::string* csv) {
  for (const NamedPercentile& percentile : kPercentiles) {
    absl::StrAppend(csv, ",", figure, "_", percentile.name);
  }
}

void AppendPercentiles(const LogHistogram& histogram, double unit, std::string* csv) {
  for (const NamedPercentile& percentile : kPercentiles) {
    absl::StrAppend(csv, ",");
    if (histogram.count() > 0) {
      absl::StrAppend(csv, Fixed(In(unit, histogram.Percentile(percentile.percent)), 3));
    }
  }
}

std::set<absl::StatusCode> AllCodes(const Report& report) {
  std::set<absl::StatusCode> codes = {absl::StatusCode::kOk};
  for (const Measurement& step : report.steps) {
    for (const auto& [code, times] : step.ended) codes.insert(code);
  }
  return codes;
}

// The calls that were not answered: "12 RESOURCE_EXHAUSTED (p50 0.4, p99 0.9 ms)".
std::string Failures(const Measurement& step) {
  std::string text;
  for (const auto& [code, times] : step.ended) {
    if (code == absl::StatusCode::kOk) continue;
    absl::StrAppend(
        &text, text.empty() ? "" : ", ", times.count(), " ", CodeName(code),
        absl::StrFormat(" (p50 %.1f, p99 %.1f ms)", In(kMillisecond, times.Percentile(50)),
                        In(kMillisecond, times.Percentile(99))));
  }
  return text.empty() ? "0" : text;
}

}  // namespace

std::string StepName(const Step& step) {
  if (step.rate_hz > 0) {
    std::string rate;
    base::AppendNumber(&rate, step.rate_hz);
    return absl::StrCat(rate, " calls/s");
  }
  return base::Counted(step.callers, "caller");
}

std::string CodeName(absl::StatusCode code) {
  const std::string name = absl::StatusCodeToString(code);
  return name.empty() ? absl::StrCat("CODE_", static_cast<int>(code)) : name;
}

std::string WhyNotKeptUp(const Measurement& measurement) {
  if (KeptUp(measurement)) return "";
  std::string text = absl::StrFormat("one call in a hundred was sent %.0f ms late or more",
                                     In(kMillisecond, measurement.late.Percentile(99)));
  if (measurement.sent < measurement.due) {
    absl::StrAppend(&text, " and ", measurement.due - measurement.sent, " of ", measurement.due,
                    " never");
  }
  return absl::StrCat(text, ": these figures also measure the generator");
}

std::string Describe(const KindName& kind) {
  return absl::StrCat(kind.model, ", ", base::Counted(kind.frames, "frame"));
}

std::string ToText(const Report& report) {
  std::string text = absl::StrCat(report.title, "\n");
  for (const KindName& kind : report.kinds) {
    absl::StrAppendFormat(&text, "  %s%s\n", Describe(kind),
                          report.kinds.size() == 1
                              ? ""
                              : absl::StrFormat(": %.1f %% of the calls", 100 * kind.share));
  }
  absl::StrAppendFormat(&text, "\n%-16s %9s %9s | %s | %s |\n", "", "answered", "frames",
                        "            whole call, ms             ", "first chunk, ms");
  absl::StrAppendFormat(&text, "%-16s %9s %9s | %7s %7s %7s %7s %7s | %7s %7s | %s\n", "load",
                        "a second", "a second", "p50", "p95", "p99", "p99.9", "max", "p50", "p99",
                        "not answered");
  for (const Measurement& step : report.steps) {
    absl::StrAppendFormat(&text, "%-16s %9.1f %9.0f |", StepName(step.step),
                          step.answered_per_second(), step.frames_per_second());
    for (const double percent : {50.0, 95.0, 99.0, 99.9, 100.0}) {
      absl::StrAppendFormat(&text, " %7.1f",
                            In(kMillisecond, step.all.whole_call.Percentile(percent)));
    }
    absl::StrAppendFormat(&text, " | %7.1f %7.1f | %s\n",
                          In(kMillisecond, step.all.first_chunk.Percentile(50)),
                          In(kMillisecond, step.all.first_chunk.Percentile(99)), Failures(step));
  }
  for (const Measurement& step : report.steps) {
    const std::string why = WhyNotKeptUp(step);
    if (!why.empty()) absl::StrAppend(&text, "\n", StepName(step.step), ": ", why, "\n");
  }
  return text;
}

std::string ToCsv(const Report& report) {
  const std::set<absl::StatusCode> codes = AllCodes(report);
  std::string csv =
      "load,callers,rate,seconds,due,sent,kept_up,late_ms_p99,answered,"
      "answered_per_second,frames_per_second";
  for (const absl::StatusCode code : codes) absl::StrAppend(&csv, ",", CodeName(code));
  for (const char* figure :
       {"first_chunk_ms", "whole_call_ms", "call_frames_per_second", "not_answered_ms"}) {
    AppendPercentileNames(figure, &csv);
  }
  csv += "\n";
  for (const Measurement& step : report.steps) {
    absl::StrAppend(&csv, Quoted(StepName(step.step)), ",");
    if (step.step.callers > 0) absl::StrAppend(&csv, step.step.callers);
    csv += ",";
    if (step.step.rate_hz > 0) base::AppendNumber(&csv, step.step.rate_hz);
    absl::StrAppend(&csv, ",", Fixed(step.seconds, 3), ",", step.due, ",", step.sent, ",",
                    KeptUp(step) ? "yes" : "no", ",",
                    Fixed(In(kMillisecond, step.late.Percentile(99)), 3), ",", step.answered(), ",",
                    Fixed(step.answered_per_second(), 3), ",", Fixed(step.frames_per_second(), 3));
    for (const absl::StatusCode code : codes) {
      const auto found = step.ended.find(code);
      absl::StrAppend(&csv, ",", found == step.ended.end() ? 0 : found->second.count());
    }
    AppendPercentiles(step.all.first_chunk, kMillisecond, &csv);
    AppendPercentiles(step.all.whole_call, kMillisecond, &csv);
    AppendPercentiles(step.all.frame_rate, kHertz, &csv);
    AppendPercentiles(NotAnswered(step), kMillisecond, &csv);
    csv += "\n";
  }
  return csv;
}

std::string RecordHeader() {
  return "load,model,frames,due_seconds,late_ms,first_chunk_ms,whole_call_ms,code,frames_"
         "received\n";
}

std::string RecordLine(const Step& step, const KindName& kind, const CallRecord& record) {
  const auto milliseconds = [](Duration time) { return Fixed(1e3 * ToSeconds(time), 3); };
  return absl::StrCat(Quoted(StepName(step)), ",", kind.model, ",", kind.frames, ",",
                      Fixed(ToSeconds(record.due), 6), ",", milliseconds(record.late), ",",
                      record.first_chunk.has_value() ? milliseconds(*record.first_chunk) : "", ",",
                      milliseconds(record.elapsed), ",", CodeName(record.code), ",", record.frames,
                      "\n");
}

}  // namespace duet::contrib::load
