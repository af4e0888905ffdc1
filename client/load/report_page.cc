#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/load/chart.h"
#include "client/load/figures.h"
#include "client/load/report.h"

namespace duet::client::load {
namespace {

using Cells = std::vector<std::string>;

constexpr char kStyle[] = R"(
:root{color-scheme:light dark}
body{font:15px/1.5 system-ui,sans-serif;max-width:1360px;margin:2rem auto;padding:0 1.2rem}
h1{font-size:1.6rem;margin-bottom:.2rem}h2{font-size:1.2rem;margin-top:2.4rem}
.faint{opacity:.7}
.warning{border-left:4px solid #d55e00;padding:.3rem .8rem;margin:.5rem 0}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,520px),1fr));gap:1.6rem}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.8rem 0}
th,td{padding:.22rem .7rem;text-align:right;white-space:nowrap}
th:first-child,td:first-child{text-align:left}
th{font-weight:600;border-bottom:1px solid currentColor}
tbody tr:nth-child(even){background:rgba(128,128,128,.09)}
caption{text-align:left;font-weight:600;padding-bottom:.3rem}
)";

std::string Row(const Cells& cells, const char* kind) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) {
    absl::StrAppend(&row, "<", kind, ">", EscapeMarkup(cell), "</", kind, ">");
  }
  return row + "</tr>\n";
}

std::string Table(const std::string& caption, const Cells& header, const std::vector<Cells>& rows) {
  std::string table = absl::StrCat("<div class=\"scroll\"><table><caption>", EscapeMarkup(caption),
                                   "</caption><thead>", Row(header, "th"), "</thead><tbody>\n");
  for (const Cells& row : rows) table += Row(row, "td");
  return table + "</tbody></table></div>\n";
}

std::string Short(double value) { return absl::StrFormat(value < 100 ? "%.1f" : "%.0f", value); }

// A row for each step and a column for each percentile.
std::string PercentileTable(const Report& report, const std::string& caption,
                            LogHistogram Answered::*figure, double unit) {
  Cells header = {"load", "calls"};
  for (const NamedPercentile& percentile : kPercentiles)
    header.push_back(std::string(percentile.name));
  std::vector<Cells> rows;
  for (const Measurement& step : report.steps) {
    const LogHistogram& histogram = step.all.*figure;
    Cells row = {StepName(step.step), absl::StrCat(histogram.count())};
    for (const NamedPercentile& percentile : kPercentiles) {
      row.push_back(
          histogram.count() == 0 ? "-" : Short(In(unit, histogram.Percentile(percentile.percent))));
    }
    rows.push_back(std::move(row));
  }
  return Table(caption, header, rows);
}

std::string LoadTable(const Report& report) {
  std::vector<Cells> rows;
  for (const Measurement& step : report.steps) {
    rows.push_back({StepName(step.step), Short(step.seconds), Short(step.due_per_second()),
                    Short(step.sent_per_second()), Short(step.answered_per_second()),
                    Short(step.frames_per_second()),
                    Short(In(kMillisecond, step.late.Percentile(99)))});
  }
  return Table("Load and throughput",
               {"load", "seconds", "calls/s wanted", "calls/s sent", "calls/s answered", "frames/s",
                "sent late, p99 ms"},
               rows);
}

std::string EndsTable(const Report& report) {
  std::vector<Cells> rows;
  for (const Measurement& step : report.steps) {
    for (const auto& [code, times] : step.ended) {
      rows.push_back({StepName(step.step), CodeName(code), absl::StrCat(times.count()),
                      Short(In(kMillisecond, times.Percentile(50))),
                      Short(In(kMillisecond, times.Percentile(99))),
                      Short(In(kMillisecond, times.max()))});
    }
  }
  return Table("How calls ended, and after how many milliseconds",
               {"load", "status", "calls", "p50", "p99", "max"}, rows);
}

std::string KindsTable(const Report& report) {
  if (report.kinds.size() < 2) return "";
  std::vector<Cells> rows;
  for (const Measurement& step : report.steps) {
    for (std::size_t i = 0; i < report.kinds.size(); ++i) {
      const Answered& answered = step.by_kind[i];
      rows.push_back({StepName(step.step), Describe(report.kinds[i]),
                      absl::StrCat(answered.whole_call.count()),
                      Short(In(kMillisecond, answered.first_chunk.Percentile(50))),
                      Short(In(kMillisecond, answered.first_chunk.Percentile(99))),
                      Short(In(kMillisecond, answered.whole_call.Percentile(50))),
                      Short(In(kMillisecond, answered.whole_call.Percentile(99)))});
    }
  }
  return Table("By kind of call, milliseconds",
               {"load", "kind", "answered", "first chunk p50", "p99", "whole call p50", "p99"},
               rows);
}

bool IsOpenLoop(const Report& report) { return report.steps.front().step.rate_hz > 0; }

double LoadOf(const Measurement& step) {
  return step.step.rate_hz > 0 ? step.step.rate_hz : step.step.callers;
}

Chart SweepChart(const Report& report) {
  Chart chart;
  chart.x_label = IsOpenLoop(report) ? "calls a second" : "callers";
  for (const Measurement& step : report.steps) {
    chart.x_ticks.push_back({LoadOf(step), StepName(step.step)});
    chart.x_ticks.back().label.resize(chart.x_ticks.back().label.find(' '));
  }
  chart.log_x = true;
  return chart;
}

std::string LatencyByLoad(const Report& report, const std::string& title,
                          LogHistogram Answered::*figure) {
  Chart chart = SweepChart(report);
  chart.title = title;
  chart.y_label = "milliseconds";
  chart.log_y = true;
  for (const NamedPercentile& percentile : kPercentiles) {
    if (percentile.percent != 50 && percentile.percent < 95) continue;
    ChartSeries series{std::string(percentile.name), {}};
    for (const Measurement& step : report.steps) {
      const LogHistogram& histogram = step.all.*figure;
      series.points.emplace_back(LoadOf(step),
                                 histogram.count() == 0
                                     ? NAN
                                     : In(kMillisecond, histogram.Percentile(percentile.percent)));
    }
    chart.series.push_back(std::move(series));
  }
  return ToSvg(chart);
}

std::string ThroughputByLoad(const Report& report) {
  Chart chart = SweepChart(report);
  chart.title = "Calls a second by load";
  chart.y_label = "calls a second";
  ChartSeries answered{"answered", {}}, sent{"sent", {}}, wanted{"wanted", {}};
  for (const Measurement& step : report.steps) {
    answered.points.emplace_back(LoadOf(step), step.answered_per_second());
    sent.points.emplace_back(LoadOf(step), step.sent_per_second());
    wanted.points.emplace_back(LoadOf(step), step.due_per_second());
  }
  chart.series = {answered, sent};
  if (IsOpenLoop(report)) chart.series.push_back(wanted);
  return ToSvg(chart);
}

// The whole distribution: each step to the right has a tenth of the calls beyond it.
std::string LatencyByPercentile(const Report& report) {
  Chart chart;
  chart.title = "Whole call by percentile";
  chart.x_label = "percentile";
  chart.y_label = "milliseconds";
  chart.log_y = true;
  chart.x_ticks = {{0, "0"}, {std::log10(2), "50"}};
  double most = 0;
  for (const Measurement& step : report.steps) {
    const LogHistogram& histogram = step.all.whole_call;
    ChartSeries series{StepName(step.step), {}};
    const double nines =
        histogram.count() > 0 ? std::log10(static_cast<double>(histogram.count())) : 0;
    for (double x = 0; x <= nines + 1e-9; x += 0.05) {
      series.points.emplace_back(
          x, In(kMillisecond, histogram.Percentile(100 * (1 - std::pow(10, -x)))));
    }
    most = std::max(most, nines);
    chart.series.push_back(std::move(series));
  }
  const char* labels[] = {"90", "99", "99.9", "99.99", "99.999"};
  for (int i = 0; i < 5 && i + 1 <= most; ++i) chart.x_ticks.push_back({i + 1.0, labels[i]});
  return ToSvg(chart);
}

std::string LatencyOverTime(const Measurement& step) {
  Chart chart;
  chart.title = StepName(step.step) + ": whole call over time";
  chart.x_label = "seconds";
  chart.y_label = "milliseconds";
  chart.log_y = true;
  chart.series = {{"p50", {}}, {"p99", {}}, {"max", {}}};
  const double percents[] = {50, 99, 100};
  for (std::size_t i = 0; i < step.timeline.size(); ++i) {
    const Interval& interval = step.timeline[i];
    const double x = static_cast<double>(i) * ToSeconds(step.interval_length);
    for (int j = 0; j < 3; ++j) {
      chart.series[j].points.emplace_back(
          x, interval.answered == 0
                 ? NAN
                 : In(kMillisecond, interval.whole_call.Percentile(percents[j])));
    }
  }
  return ToSvg(chart);
}

std::string CallsOverTime(const Measurement& step) {
  Chart chart;
  chart.title = StepName(step.step) + ": calls over time";
  chart.x_label = "seconds";
  chart.y_label = "calls a second";
  chart.series = {{"due", {}}, {"answered", {}}, {"not answered", {}}};
  const double length = ToSeconds(step.interval_length);
  for (std::size_t i = 0; i < step.timeline.size(); ++i) {
    const Interval& interval = step.timeline[i];
    const double x = static_cast<double>(i) * length;
    const int64_t counts[] = {interval.due, interval.answered, interval.failed};
    for (int j = 0; j < 3; ++j) {
      chart.series[j].points.emplace_back(x, static_cast<double>(counts[j]) / length);
    }
  }
  return ToSvg(chart);
}

std::string Charts(const Report& report) {
  std::string html = "<div class=\"charts\">\n";
  const auto add = [&html](const std::string& svg) {
    absl::StrAppend(&html, "<figure>", svg, "</figure>\n");
  };
  if (report.steps.size() > 1) {
    add(LatencyByLoad(report, "First chunk by load", &Answered::first_chunk));
    add(LatencyByLoad(report, "Whole call by load", &Answered::whole_call));
    add(ThroughputByLoad(report));
  }
  add(LatencyByPercentile(report));
  for (const Measurement& step : report.steps) {
    if (step.timeline.size() < 2) continue;
    add(LatencyOverTime(step));
    add(CallsOverTime(step));
  }
  return html + "</div>\n";
}

}  // namespace

std::string ToPage(const Report& report) {
  std::string html = absl::StrCat(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>",
      EscapeMarkup(report.title), "</title>\n<style>", kStyle, "figure{margin:0}\n", ChartStyle(),
      "</style></head><body>\n<h1>", EscapeMarkup(report.title), "</h1>\n<p class=\"faint\">",
      EscapeMarkup(absl::StrCat(report.program, ", ", report.time)), "<br>");
  for (const auto& [name, value] : report.settings) {
    absl::StrAppend(&html, EscapeMarkup(absl::StrCat("--", name, " ", value, "  ")));
  }
  html += "</p>\n";
  for (const Measurement& step : report.steps) {
    const std::string why = WhyNotKeptUp(step);
    if (why.empty()) continue;
    absl::StrAppend(&html, "<p class=\"warning\">",
                    EscapeMarkup(absl::StrCat(StepName(step.step), ": ", why)), "</p>\n");
  }
  absl::StrAppend(
      &html, "<p>Times run from when a call was due, not from when it was sent.</p>\n",
      Charts(report), LoadTable(report), EndsTable(report),
      PercentileTable(report, "First chunk, milliseconds", &Answered::first_chunk, kMillisecond),
      PercentileTable(report, "Whole call, milliseconds", &Answered::whole_call, kMillisecond),
      PercentileTable(report, "Frames a second of each call", &Answered::frame_rate, kHertz),
      KindsTable(report), "</body></html>\n");
  return html;
}

}  // namespace duet::client::load
