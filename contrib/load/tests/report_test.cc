#include "contrib/load/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "absl/strings/str_split.h"
#include "contrib/load/generator.h"
#include "contrib/load/tests/simulated_server.h"

namespace duet::contrib::load {
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

// A step without calls.
Report EmptyReport() {
  Report report;
  report.steps.resize(1);
  report.steps[0].step.callers = 1;
  return report;
}

TEST(ReportTest, TableHasEachStepAndItsRejections) {
  const std::string text = ToText(TwoRates());
  EXPECT_THAT(text, HasSubstr("sbu@2, 460 frames: 25.0 % of the calls"));
  EXPECT_THAT(text, HasSubstr("50 calls/s            50.0      2250 |    10.0"));
  EXPECT_THAT(text, HasSubstr("RESOURCE_EXHAUSTED (p50 0.0, p99 0.0 ms)"));
  EXPECT_THAT(text, Not(HasSubstr("these figures also measure the generator")));
}

TEST(ReportTest, ReportsThatTheGeneratorDidNotKeepUp) {
  const Report report = TwoRates(1);
  EXPECT_EQ(WhyNotKeptUp(report.steps[0]), "");
  EXPECT_THAT(WhyNotKeptUp(report.steps[1]),
              ::testing::ContainsRegex("was sent [0-9]+ ms late or more and [0-9]+ of 2000 never"));
  EXPECT_THAT(ToText(report), HasSubstr("200 calls/s: "));
  const auto steps = nlohmann::json::parse(ToJson(report))["steps"];
  EXPECT_FALSE(steps[0].contains("not_kept_up"));
  EXPECT_EQ(steps[1]["not_kept_up"], WhyNotKeptUp(report.steps[1]));
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

TEST(ReportTest, JsonHasTheWholeDistribution) {
  const auto step = nlohmann::json::parse(ToJson(TwoRates()))["steps"][0];
  const auto& percentiles = step["whole_call_percentiles"];
  EXPECT_EQ(percentiles.front()[0], 0);
  EXPECT_NEAR(percentiles.front()[1].get<double>(), 10, 0.1);
  EXPECT_NEAR(percentiles.back()[0].get<double>(), 99.8, 0.05);  // of 500 calls
  EXPECT_EQ(nlohmann::json::parse(ToJson(EmptyReport()))["steps"][0]["whole_call_percentiles"],
            nlohmann::json::array());
}

TEST(ReportTest, PageHoldsTheJsonAndNeedsNoOtherFile) {
  const Report report = TwoRates();
  const std::string page = ToPage(report);
  for (const char* foreign : {"src=", "href=", "url(", "@import", "https://", "{{"}) {
    EXPECT_THAT(page, Not(HasSubstr(foreign)));
  }
  const std::string start = "<script type=\"application/json\" id=\"report\">";
  const size_t begin = page.find(start) + start.size();
  const std::string json = page.substr(begin, page.find("</script>", begin) - begin);
  EXPECT_THAT(json, Not(HasSubstr("<"))) << "a title would end the script";
  EXPECT_EQ(nlohmann::json::parse(json), nlohmann::json::parse(ToJson(report)));
}

TEST(ReportTest, EachRecordIsALine) {
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

}  // namespace
}  // namespace duet::contrib::load
