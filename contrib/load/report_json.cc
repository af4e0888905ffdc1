#include "contrib/load/report_json.h"

#include <cmath>

#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"

// Linked in by duet_embed_file.
extern "C" {
extern const char duet_load_page[], duet_load_page_end[];
extern const char duet_load_style[], duet_load_style_end[];
extern const char duet_load_script[], duet_load_script_end[];
}

namespace duet::contrib::load {
namespace {

absl::string_view Embedded(const char* begin, const char* end) {
  return {begin, static_cast<size_t>(end - begin)};
}

Json ToJson(const Answered& answered) {
  Json json;
  json["first_chunk_ms"] = Distribution(answered.first_chunk, kMillisecond);
  json["whole_call_ms"] = Distribution(answered.whole_call, kMillisecond);
  json["call_frames_per_second"] = Distribution(answered.frame_rate, kHertz);
  return json;
}

Json Timeline(const Measurement& measurement) {
  Json timeline = Json::array();
  double second = 0;
  for (const Interval& interval : measurement.timeline) {
    Json json;
    json["second"] = second;
    json["due"] = interval.due;
    json["answered"] = interval.answered;
    json["not_answered"] = interval.failed;
    for (const double percent : {50.0, 99.0, 100.0}) {
      if (interval.answered == 0) break;
      json[percent == 50   ? "p50_ms"
           : percent == 99 ? "p99_ms"
                           : "max_ms"] = In(kMillisecond, interval.whole_call.Percentile(percent));
    }
    timeline.push_back(std::move(json));
    second += ToSeconds(measurement.interval_length);
  }
  return timeline;
}

Json ToJson(const Measurement& step, const std::vector<KindName>& kinds) {
  Json json;
  json["load"] = StepName(step.step);
  if (step.step.callers > 0) json["callers"] = step.step.callers;
  if (step.step.rate_hz > 0) json["rate"] = step.step.rate_hz;
  json["measured_from_unix"] = step.began_unix;
  json["seconds"] = step.seconds;
  json["due"] = step.due;
  json["sent"] = step.sent;
  json["due_per_second"] = step.due_per_second();
  json["sent_per_second"] = step.sent_per_second();
  json["kept_up"] = KeptUp(step);
  if (!KeptUp(step)) json["not_kept_up"] = WhyNotKeptUp(step);
  json["late_ms"] = Distribution(step.late, kMillisecond);
  json["answered"] = step.answered();
  json["answered_per_second"] = step.answered_per_second();
  json["frames_per_second"] = step.frames_per_second();
  Json counts = Json::object(), times = Json::object(), background = Json::object();
  for (const auto& [code, histogram] : step.ended) {
    counts[CodeName(code)] = histogram.count();
    times[CodeName(code)] = Distribution(histogram, kMillisecond);
  }
  for (const auto& [code, count] : step.background) background[CodeName(code)] = count;
  json["ended"] = std::move(counts);
  json["ended_ms"] = std::move(times);
  json["background_ended"] = std::move(background);
  json["answers"] = ToJson(step.all);
  json["kinds"] = Json::array();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Json kind;
    kind["model"] = kinds[i].model;
    kind["frames"] = kinds[i].frames;
    kind["answers"] = ToJson(step.by_kind[i]);
    json["kinds"].push_back(std::move(kind));
  }
  json["whole_call_percentiles"] = Percentiles(step.all.whole_call);
  json["timeline"] = Timeline(step);
  return json;
}

}  // namespace

Json Distribution(const LogHistogram& histogram, double unit) {
  Json json;
  json["count"] = histogram.count();
  if (histogram.count() == 0) return json;
  json["mean"] = histogram.mean() / unit;
  for (const NamedPercentile& percentile : kPercentiles) {
    json[std::string(percentile.name)] = In(unit, histogram.Percentile(percentile.percent));
  }
  return json;
}

Json Percentiles(const LogHistogram& histogram) {
  Json percentiles = Json::array();
  if (histogram.count() == 0) return percentiles;
  const double nines = std::log10(static_cast<double>(histogram.count()));
  for (double x = 0; x <= nines + 1e-9; x += 0.05) {
    const double percent = 100 * (1 - std::pow(10, -x));
    percentiles.push_back({percent, In(kMillisecond, histogram.Percentile(percent))});
  }
  return percentiles;
}

Json ToJson(const ReportHead& head) {
  Json json;
  json["program"] = head.program;
  json["title"] = head.title;
  json["time"] = head.time;
  json["server"] = head.server;
  json["settings"] = Json::object();
  for (const auto& [name, value] : head.settings) json["settings"][name] = value;
  return json;
}

std::string Dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string ToJson(const Report& report) {
  Json json = ToJson(static_cast<const ReportHead&>(report));
  json["steps"] = Json::array();
  for (const Measurement& step : report.steps) json["steps"].push_back(ToJson(step, report.kinds));
  return Dump(json);
}

std::string PageOf(const std::string& json) {
  // "</script>" inside a string would end the script. In JSON, "<" occurs only inside strings,
  // where it may be written as an escape.
  const std::string escaped = absl::StrReplaceAll(json, {{"<", "\\u003c"}});
  return absl::StrReplaceAll(Embedded(duet_load_page, duet_load_page_end),
                             {{"{{STYLE}}", Embedded(duet_load_style, duet_load_style_end)},
                              {"{{REPORT}}", escaped},
                              {"{{SCRIPT}}", Embedded(duet_load_script, duet_load_script_end)}});
}

std::string ToPage(const Report& report) { return PageOf(ToJson(report)); }

}  // namespace duet::contrib::load
