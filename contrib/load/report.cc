#include "contrib/load/report.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "model/base/counted.h"
#include "model/base/text.h"

namespace duet::contrib::load {
namespace {

using Json = nlohmann::ordered_json;

std::string CodeName(absl::StatusCode code) {
  const std::string name = absl::StatusCodeToString(code);
  return name.empty() ? absl::StrCat("CODE_", static_cast<int>(code)) : name;
}

double PercentOf(int64_t part, int64_t all) {
  return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0;
}

// Why the generator did not keep up; empty if it did. `what`: "call", "frame".
template <typename Figures>
std::string WhyNotKeptUp(const Figures& step, const Times& late, const char* what) {
  if (step.kept_up()) return "";
  return absl::StrFormat(
      "one %s in a hundred was sent %.0f ms late or more: these figures also measure the generator",
      what, late.Ms(99));
}

std::string WhyNotKeptUp(const CallFigures& step) {
  if (step.sent == step.due) return WhyNotKeptUp(step, step.late, "call");
  return absl::StrCat(step.due - step.sent, " of ", step.due,
                      " calls were never sent: these figures also measure the generator");
}
std::string WhyNotKeptUp(const LiveFigures& step) {
  return WhyNotKeptUp(step, step.late_sent, "frame");
}

// The calls that were not answered: "12 RESOURCE_EXHAUSTED (p50 0.4, p99 0.9 ms)".
std::string Failures(const CallFigures& step) {
  std::string text;
  for (const auto& [code, times] : step.ended) {
    if (code == absl::StatusCode::kOk) continue;
    absl::StrAppend(&text, text.empty() ? "" : ", ", times.count(), " ", CodeName(code),
                    absl::StrFormat(" (p50 %.1f, p99 %.1f ms)", times.Ms(50), times.Ms(99)));
  }
  return text.empty() ? "0" : text;
}

// What went wrong: "2 refused, 1 UNAVAILABLE, 3 frames lost".
std::string Troubles(const LiveFigures& step) {
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

std::string CallRow(const CallFigures& step) {
  std::string text = absl::StrFormat("%-16s %9.1f %9.0f |", StepName(step.load),
                                     step.answered_per_second(), step.frames_per_second());
  for (const double percent : {50.0, 95.0, 99.0, 99.9, 100.0}) {
    absl::StrAppendFormat(&text, " %7.1f", step.whole_call.Ms(percent));
  }
  return absl::StrFormat("%s | %7.1f %7.1f | %s\n", text, step.first_chunk.Ms(50),
                         step.first_chunk.Ms(99), Failures(step));
}

std::string LiveRow(const LiveFigures& step) {
  std::string text =
      absl::StrFormat("%-14s %8.0f |", StepName(step),
                      step.seconds > 0 ? static_cast<double>(step.answered) / step.seconds : 0);
  for (const double percent : {50.0, 99.0, 99.9, 100.0}) {
    absl::StrAppendFormat(&text, " %7.1f", step.latency.Ms(percent));
  }
  return absl::StrFormat("%s | %6.2f %6.2f %7d | %7.1f %7.1f | %s\n", text,
                         PercentOf(step.late, step.sent), PercentOf(step.missed, step.sent),
                         step.skipped, step.first_frame.Ms(50), step.first_frame.Ms(100),
                         Troubles(step));
}

// Count, mean and percentiles in milliseconds.
Json Distribution(const Times& times) {
  Json json;
  json["count"] = times.count();
  if (times.count() == 0) return json;
  json["mean"] = times.MeanMs();
  constexpr std::pair<const char*, double> kPercentiles[] = {
      {"min", 0},  {"p1", 1},   {"p5", 5},       {"p50", 50}, {"p90", 90},
      {"p95", 95}, {"p99", 99}, {"p99.9", 99.9}, {"max", 100}};
  for (const auto& [name, percent] : kPercentiles) json[name] = times.Ms(percent);
  return json;
}

Json ToJson(const CallFigures& step) {
  Json json;
  json["load"] = StepName(step.load);
  if (step.load.callers > 0) json["callers"] = step.load.callers;
  if (step.load.rate_hz > 0) json["rate"] = step.load.rate_hz;
  json["seconds"] = step.seconds;
  json["due"] = step.due;
  json["sent"] = step.sent;
  json["kept_up"] = step.kept_up();
  json["late_ms"] = Distribution(step.late);
  json["answered"] = step.whole_call.count();
  json["answered_per_second"] = step.answered_per_second();
  json["frames_per_second"] = step.frames_per_second();
  json["ended"] = json["ended_ms"] = Json::object();
  for (const auto& [code, times] : step.ended) {
    json["ended"][CodeName(code)] = times.count();
    json["ended_ms"][CodeName(code)] = Distribution(times);
  }
  json["answers"] = {{"first_chunk_ms", Distribution(step.first_chunk)},
                     {"whole_call_ms", Distribution(step.whole_call)}};
  return json;
}

Json ToJson(const LiveFigures& step) {
  Json json;
  json["load"] = StepName(step);
  json["sessions"] = step.sessions;
  json["seconds"] = step.seconds;
  json["sent"] = step.sent;
  json["answered"] = step.answered;
  json["kept_up"] = step.kept_up();
  json["late_sent_ms"] = Distribution(step.late_sent);
  json["latency_ms"] = Distribution(step.latency);
  json["at_server_ms"] = Distribution(step.at_server);
  json["first_frame_ms"] = Distribution(step.first_frame);
  const std::pair<const char*, int64_t> counts[] = {
      {"late", step.late}, {"missed", step.missed},   {"skipped", step.skipped},
      {"lost", step.lost}, {"doubled", step.doubled}, {"refused", step.refused}};
  for (const auto& [name, count] : counts) json[name] = count;
  json["ended"] = Json::object();
  for (const auto& [code, count] : step.ended) json["ended"][CodeName(code)] = count;
  return json;
}

}  // namespace

std::string StepName(const CallLoad& load) {
  if (load.rate_hz <= 0) return base::Counted(load.callers, "caller");
  std::string rate;
  base::AppendNumber(&rate, load.rate_hz);
  return absl::StrCat(rate, " calls/s");
}

std::string StepName(const LiveFigures& step) { return base::Counted(step.sessions, "session"); }

bool IsAnswered(const Report& report) {
  const auto has_answers = [](const CallFigures& step) { return step.whole_call.count() > 0; };
  const auto has_frames = [](const LiveFigures& step) { return step.answered > 0; };
  return std::any_of(report.calls.begin(), report.calls.end(), has_answers) ||
         std::any_of(report.live.begin(), report.live.end(), has_frames);
}

std::string ToText(const Report& report) {
  std::string text = absl::StrCat(report.server, ", ", report.model, "\n\n"), notes;
  const auto note = [&notes](const std::string& name, const std::string& why) {
    if (!why.empty()) absl::StrAppend(&notes, "\n", name, ": ", why, "\n");
  };
  if (report.live.empty()) {
    absl::StrAppendFormat(&text, "%-16s %9s %9s | %-39s | %-15s |\n", "", "answered", "frames",
                          "whole call, ms", "first chunk, ms");
    absl::StrAppendFormat(&text, "%-16s %9s %9s | %7s %7s %7s %7s %7s | %7s %7s | %s\n", "load",
                          "a second", "a second", "p50", "p95", "p99", "p99.9", "max", "p50", "p99",
                          "not answered");
  } else {
    absl::StrAppendFormat(&text, "%-14s %8s | %-31s | %6s %6s %7s | %-15s |\n", "", "frames",
                          "latency, ms", "late", "missed", "skipped", "first frame, ms");
    absl::StrAppendFormat(&text, "%-14s %8s | %7s %7s %7s %7s | %6s %6s %7s | %7s %7s | %s\n",
                          "load", "a second", "p50", "p99", "p99.9", "max", "%", "%", "", "p50",
                          "max", "troubles");
  }
  for (const CallFigures& step : report.calls) {
    text += CallRow(step);
    note(StepName(step.load), WhyNotKeptUp(step));
  }
  for (const LiveFigures& step : report.live) {
    text += LiveRow(step);
    note(StepName(step), WhyNotKeptUp(step));
  }
  return text + notes;
}

std::string ToJson(const Report& report) {
  Json json;
  json["program"] = report.program;
  json["time"] = report.time;
  json["server"] = report.server;
  json["model"] = report.model;
  for (const CallFigures& step : report.calls) json["steps"].push_back(ToJson(step));
  for (const LiveFigures& step : report.live) json["live"].push_back(ToJson(step));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace duet::contrib::load
