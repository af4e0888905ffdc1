#include "contrib/load/live_report.h"

#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "contrib/load/report_json.h"
#include "model/base/counted.h"

namespace duet::contrib::load {
namespace {

double Milliseconds(const LogHistogram& histogram, double percent) {
  return In(kMillisecond, histogram.Percentile(percent));
}

double PercentOf(int64_t part, int64_t all) {
  return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0;
}

std::string WhyNotKeptUp(const LiveMeasurement& step) {
  if (KeptUp(step)) return "";
  return absl::StrFormat(
      "one frame in a hundred was sent %.0f ms late or more: these figures also measure the "
      "generator",
      Milliseconds(step.late_sent, 99));
}

// What went wrong: "2 refused, 1 UNAVAILABLE, 3 frames lost".
std::string Troubles(const LiveMeasurement& step) {
  std::string text;
  const auto add = [&](int64_t count, const std::string& what) {
    if (count > 0) absl::StrAppend(&text, text.empty() ? "" : ", ", count, " ", what);
  };
  add(step.refused, "refused");
  for (const auto& [code, count] : step.ended) {
    if (code != absl::StatusCode::kOk) add(count, CodeName(code));
  }
  add(step.lost, "frames lost");
  add(step.doubled, "frames doubled");
  return text.empty() ? "none" : text;
}

Json Timeline(const LiveMeasurement& step) {
  Json timeline = Json::array();
  double second = 0;
  for (const LiveInterval& interval : step.timeline) {
    Json json;
    json["second"] = second;
    json["sent"] = interval.sent;
    json["late"] = interval.late;
    json["missed"] = interval.missed;
    if (interval.latency.count() > 0) {
      json["p50_ms"] = Milliseconds(interval.latency, 50);
      json["p99_ms"] = Milliseconds(interval.latency, 99);
      json["max_ms"] = Milliseconds(interval.latency, 100);
    }
    timeline.push_back(std::move(json));
    second += ToSeconds(step.interval_length);
  }
  return timeline;
}

Json ToJson(const LiveMeasurement& step) {
  Json json;
  json["load"] = StepName(step);
  json["sessions"] = step.sessions;
  json["frame_rate"] = step.frame_rate_hz;
  json["measured_from_unix"] = step.began_unix;
  json["seconds"] = step.seconds;
  json["sent"] = step.sent;
  json["answered"] = step.answered;
  json["kept_up"] = KeptUp(step);
  if (!KeptUp(step)) json["not_kept_up"] = WhyNotKeptUp(step);
  json["late_sent_ms"] = Distribution(step.late_sent, kMillisecond);
  json["latency_ms"] = Distribution(step.latency, kMillisecond);
  json["at_server_ms"] = Distribution(step.at_server, kMillisecond);
  json["first_frame_ms"] = Distribution(step.first_frame, kMillisecond);
  json["late"] = step.late;
  json["missed"] = step.missed;
  json["skipped"] = step.skipped;
  json["interpolated"] = step.interpolated;
  json["dropped"] = step.dropped;
  json["lost"] = step.lost;
  json["doubled"] = step.doubled;
  json["refused"] = step.refused;
  json["ended"] = Json::object();
  for (const auto& [code, count] : step.ended) json["ended"][CodeName(code)] = count;
  json["latency_percentiles"] = Percentiles(step.latency);
  json["timeline"] = Timeline(step);
  return json;
}

}  // namespace

std::string StepName(const LiveMeasurement& step) {
  return base::Counted(step.sessions, "session");
}

std::string ToText(const LiveReport& report) {
  std::string text = absl::StrCat(report.title, "\n  ", report.model, ", delay ",
                                  report.delay_frames, " frames\n");
  absl::StrAppendFormat(&text, "\n%-14s %8s | %s | %6s %6s %7s | %s | %s\n", "", "frames",
                        "          latency, ms          ", "late", "missed", "skipped",
                        "first frame, ms", "");
  absl::StrAppendFormat(&text, "%-14s %8s | %7s %7s %7s %7s | %6s %6s %7s | %7s %7s | %s\n", "load",
                        "a second", "p50", "p99", "p99.9", "max", "%", "%", "", "p50", "max",
                        "troubles");
  for (const LiveMeasurement& step : report.steps) {
    absl::StrAppendFormat(&text, "%-14s %8.0f |", StepName(step),
                          step.seconds > 0 ? static_cast<double>(step.answered) / step.seconds : 0);
    for (const double percent : {50.0, 99.0, 99.9, 100.0}) {
      absl::StrAppendFormat(&text, " %7.1f", Milliseconds(step.latency, percent));
    }
    absl::StrAppendFormat(&text, " | %6.2f %6.2f %7d | %7.1f %7.1f | %s\n",
                          PercentOf(step.late, step.sent), PercentOf(step.missed, step.sent),
                          step.skipped, Milliseconds(step.first_frame, 50),
                          Milliseconds(step.first_frame, 100), Troubles(step));
  }
  for (const LiveMeasurement& step : report.steps) {
    const std::string why = WhyNotKeptUp(step);
    if (!why.empty()) absl::StrAppend(&text, "\n", StepName(step), ": ", why, "\n");
  }
  return text;
}

std::string ToJson(const LiveReport& report) {
  Json json = ToJson(static_cast<const ReportHead&>(report));
  json["model"] = report.model;
  json["delay_frames"] = report.delay_frames;
  json["live"] = Json::array();
  for (const LiveMeasurement& step : report.steps) json["live"].push_back(ToJson(step));
  return Dump(json);
}

std::string ToPage(const LiveReport& report) { return PageOf(ToJson(report)); }

}  // namespace duet::contrib::load
