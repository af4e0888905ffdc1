#include "contrib/load/live_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "contrib/load/live_generator.h"
#include "contrib/load/tests/simulated_live_server.h"

namespace duet::contrib::load {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// 2 and 4 sessions of a server that takes three and doubles a frame.
LiveReport TwoSteps() {
  LiveReport report;
  report.title = "Live <here>";
  report.program = "duet-load 0";
  report.settings = {{"live", "2,4"}};
  report.model = "sbu@2";
  report.delay_frames = 1;
  for (const int sessions : {2, 4}) {
    SimulatedLiveServer server;
    server.max_sessions = 3;
    if (sessions == 4) server.repeats = {50};
    LiveOptions options;
    options.sessions = sessions;
    report.steps.push_back(RunLive(options, server));
  }
  return report;
}

TEST(LiveReportTest, TableHasEachStepAndItsTroubles) {
  const std::string text = ToText(TwoSteps());
  EXPECT_THAT(text, HasSubstr("sbu@2, delay 1 frames"));
  EXPECT_THAT(text,
              HasSubstr("2 sessions           60 |     5.0     5.0     5.0     5.0 |   0.00   "
                        "0.00       6 |     5.0     5.0 | none"));
  EXPECT_THAT(text, HasSubstr("| 1 refused, 1 RESOURCE_EXHAUSTED, 3 frames doubled"));
  EXPECT_THAT(text, Not(HasSubstr("measure the generator")));
}

TEST(LiveReportTest, ReportsThatTheGeneratorDidNotKeepUp) {
  LiveReport report = TwoSteps();
  report.steps.resize(1);
  for (int i = 0; i < 100; ++i) report.steps[0].late_sent.Add(20'000'000);
  EXPECT_THAT(ToText(report), HasSubstr("2 sessions: one frame in a hundred was sent 20 ms late or "
                                        "more: these figures also measure the generator"));
  EXPECT_EQ(nlohmann::json::parse(ToJson(report))["live"][0]["kept_up"], false);
}

TEST(LiveReportTest, JsonHasEverything) {
  const auto json = nlohmann::json::parse(ToJson(TwoSteps()));
  EXPECT_EQ(json["settings"]["live"], "2,4");
  EXPECT_EQ(json["model"], "sbu@2");
  EXPECT_EQ(json["delay_frames"], 1);
  ASSERT_EQ(json["live"].size(), 2U);
  const auto& step = json["live"][1];
  EXPECT_EQ(step["sessions"], 4);
  EXPECT_EQ(step["answered"], step["sent"]);
  EXPECT_EQ(step["refused"], 1);
  EXPECT_EQ(step["doubled"], 3);
  EXPECT_EQ(step["lost"], 0);
  EXPECT_EQ(step["skipped"], 4 * 3);
  EXPECT_EQ(step["ended"]["OK"], 3);
  EXPECT_NEAR(step["latency_ms"]["p99"].get<double>(), 5, 0.1);
  EXPECT_EQ(step["first_frame_ms"]["count"], 3);
  EXPECT_EQ(step["timeline"].size(), 10U);
  EXPECT_EQ(step["timeline"][0]["sent"], 90);
}

TEST(LiveReportTest, PageHoldsTheJson) {
  const std::string page = ToPage(TwoSteps());
  EXPECT_THAT(page, HasSubstr("\"live\": ["));
  EXPECT_THAT(page, HasSubstr("Live \\u003chere>"));
  EXPECT_THAT(page, HasSubstr("function drawLive("));
}

TEST(LiveReportTest, AStepWithoutAnswersHasNoFigures) {
  LiveReport report;
  report.steps.resize(1);
  report.steps[0].sessions = 1;
  EXPECT_THAT(ToText(report), HasSubstr("1 session "));
  EXPECT_EQ(nlohmann::json::parse(ToJson(report))["live"][0]["latency_ms"]["count"], 0);
}

}  // namespace
}  // namespace duet::contrib::load
