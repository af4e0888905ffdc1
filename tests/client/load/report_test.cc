#include "client/load/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "absl/strings/str_split.h"
#include "client/load/chart.h"
#include "client/load/generator.h"
#include "tests/client/load/simulated_server.h"

namespace duet::client::load {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Two rates of a server that answers 100 calls a second and refuses the rest.
Report TwoRates(int max_in_flight = 4096) {
  Report report;
  report.title = "Load on <here> & there";
  report.program = "duet-load 0";
  report.time = "2026-05-01 12:00:00 UTC";
  report.server = "lab:50051";
  report.settings = {{"rate", "50,200"}};
  report.kinds = {{"sbu@2", 46, 0.75}, {"sbu@2", 460, 0.25}};
  for (const double rate : {50.0, 200.0}) {
    SimulatedServer server;
    server.max_calls = 3;
    LoadOptions options;
    options.kind_weights = {3, 1};
    options.arrivals = ArrivalKind::kConstant;
    options.max_in_flight = max_in_flight;
    report.steps.push_back(RunStep({0, rate}, options, server));
  }
  return report;
}

TEST(ReportTest, TheTableHasEachStepAndWhatWasRefused) {
  const std::string text = ToText(TwoRates());
  EXPECT_THAT(text, HasSubstr("sbu@2, 460 frames: 25.0 % of the calls"));
  EXPECT_THAT(text, HasSubstr("50 calls/s            50.0      2250 |    10.0"));
  EXPECT_THAT(text, HasSubstr("RESOURCE_EXHAUSTED (p50 0.0, p99 0.0 ms)"));
  EXPECT_THAT(text, Not(HasSubstr("these figures tell of the generator")));
}

TEST(ReportTest, SaysWhereTheGeneratorDidNotKeepUp) {
  const Report report = TwoRates(1);
  EXPECT_EQ(WhyNotKeptUp(report.steps[0]), "");
  EXPECT_THAT(WhyNotKeptUp(report.steps[1]),
              ::testing::ContainsRegex("was sent [0-9]+ ms late or more and [0-9]+ of 2000 never"));
  EXPECT_THAT(ToText(report), HasSubstr("200 calls/s: "));
  EXPECT_THAT(ToPage(report), HasSubstr("<p class=\"warning\">200 calls/s: "));
}

TEST(ReportTest, JsonHasEverything) {
  const auto json = nlohmann::json::parse(ToJson(TwoRates()));
  EXPECT_EQ(json["settings"]["rate"], "50,200");
  ASSERT_EQ(json["steps"].size(), 2U);
  const auto& step = json["steps"][1];
  EXPECT_EQ(step["rate"], 200);
  EXPECT_EQ(step["due"], 2000);
  EXPECT_EQ(step["kept_up"], true);
  EXPECT_EQ(step["ended"]["OK"].get<int>() + step["ended"]["RESOURCE_EXHAUSTED"].get<int>(), 2000);
  EXPECT_NEAR(step["answered_per_second"].get<double>(), 100, 1);
  for (const char* name : {"min", "p1", "p5", "p50", "p90", "p95", "p99", "p99.9", "max", "mean"}) {
    EXPECT_NEAR(json["steps"][0]["answers"]["whole_call_ms"][name].get<double>(), 10, 0.1) << name;
    EXPECT_NEAR(json["steps"][0]["answers"]["first_chunk_ms"][name].get<double>(), 5, 0.1) << name;
  }
  EXPECT_EQ(step["kinds"].size(), 2U);
  EXPECT_EQ(step["timeline"].size(), 10U);
  EXPECT_EQ(step["timeline"][3]["due"], 200);
}

TEST(ReportTest, CsvHasACellForEachColumn) {
  const std::vector<std::string> lines = absl::StrSplit(ToCsv(TwoRates()), '\n');
  ASSERT_EQ(lines.size(), 4U);  // the last one empty
  const std::vector<std::string> names = absl::StrSplit(lines[0], ',');
  const std::vector<std::string> cells = absl::StrSplit(lines[2], ',');
  ASSERT_EQ(names.size(), cells.size());
  const auto cell = [&](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? "no " + name
                                : cells[static_cast<std::size_t>(found - names.begin())];
  };
  EXPECT_EQ(cell("rate"), "200");
  EXPECT_EQ(cell("callers"), "");
  EXPECT_EQ(cell("sent"), "2000");
  EXPECT_EQ(cell("RESOURCE_EXHAUSTED"), std::to_string(2000 - std::stoi(cell("OK"))));
  EXPECT_NEAR(std::stod(cell("whole_call_ms_p99.9")), 30, 1);
}

TEST(ReportTest, ThePageStandsAlone) {
  const std::string page = ToPage(TwoRates());
  EXPECT_THAT(page, HasSubstr("<h1>Load on &lt;here&gt; &amp; there</h1>"));
  for (const char* foreign : {"<script", "src=", "href=", "url(", "@import"}) {
    EXPECT_THAT(page, Not(HasSubstr(foreign)));
  }
  EXPECT_THAT(page, HasSubstr("Calls a second by load"));
  EXPECT_THAT(page, HasSubstr("200 calls/s: whole call over time"));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST(ReportTest, ARecordIsALine) {
  CallRecord record;
  record.due = Seconds(1.5);
  record.late = Seconds(0.001);
  record.elapsed = Seconds(0.0205);
  record.first_chunk = Seconds(0.01);
  record.frames = 46;
  EXPECT_EQ(RecordLine({8, 0}, {"sbu@2", 46, 1}, record),
            "\"8 callers\",sbu@2,46,1.500000,1.000,10.000,20.500,OK,46\n");
  record.first_chunk.reset();
  record.code = absl::StatusCode::kUnavailable;
  EXPECT_EQ(RecordLine({0, 12.5}, {"sbu@2", 46, 1}, record),
            "\"12.5 calls/s\",sbu@2,46,1.500000,1.000,,20.500,UNAVAILABLE,46\n");
}

TEST(ChartTest, ValuesStandWhereTheAxesSay) {
  Chart chart;
  chart.title = "T";
  chart.series = {{"a", {{0, 0}, {5, 50}, {10, 100}}}};
  const std::string svg = ToSvg(chart);
  // The middle of the x axis, and half of 106 % of the height.
  EXPECT_THAT(svg, HasSubstr("M66.0 294.0L345.0 184.6L624.0 75.1\" class=\"s0\""));
  EXPECT_THAT(svg, HasSubstr(">100</text>"));
}

TEST(ChartTest, WhatCannotBeDrawnLeavesAGap) {
  Chart chart;
  chart.log_y = true;
  chart.series = {{"a", {{1, 10}, {2, 0}, {3, 10}, {4, 100}}}};
  const std::string svg = ToSvg(chart);
  // One point alone, then a line of two.
  EXPECT_THAT(svg, ::testing::ContainsRegex(
                       "<path d=\"M66.0 [0-9.]+M438.0 [0-9.]+L624.0 [0-9.]+\" class=\"s0\"/>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(ChartTest, EvenAPartOfADecadeHasTicks) {
  Chart chart;
  chart.log_y = true;
  chart.series = {{"a", {{0, 500}, {1, 900}}}};
  const std::string svg = ToSvg(chart);
  for (const char* label : {">500<", ">600<", ">900<", ">1000<"}) {
    EXPECT_THAT(svg, HasSubstr(label));
  }
  EXPECT_THAT(svg, Not(HasSubstr(">400<")));
}

TEST(ChartTest, NothingIsAnEmptyChart) { EXPECT_THAT(ToSvg(Chart()), HasSubstr("</svg>")); }

}  // namespace
}  // namespace duet::client::load
