#include "contrib/load/program/load_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "contrib/load/program/load_program.h"

namespace duet::contrib::load::program {
namespace {

using ::testing::HasSubstr;

struct Ran {
  int code;
  std::string out;
  std::string err;
};

Ran RunWith(const std::vector<std::string>& arguments) {
  std::ostringstream out, err;
  const int code = RunLoadProgram(arguments, {&out, &err, [] { return false; }});
  return {code, out.str(), err.str()};
}

LoadArguments Parse(const std::vector<std::string>& arguments) {
  CLI::App app;
  LoadArguments parsed;
  AddLoadFlags(&app, &parsed);
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  return parsed;
}

TEST(LoadFlagsTest, EachValueIsAStep) {
  const std::vector<Step> callers = Parse({"--callers", "1,8,64"}).Steps();
  ASSERT_EQ(callers.size(), 3U);
  EXPECT_EQ(callers[2].callers, 64);
  const std::vector<Step> rates = Parse({"--rate", "0.5,100"}).Steps();
  ASSERT_EQ(rates.size(), 2U);
  EXPECT_EQ(rates[0].rate_hz, 0.5);
  EXPECT_EQ(Parse({}).Steps().front().callers, 1);
}

TEST(LoadFlagsTest, ReadsOutputsAndTheTitleOfTheReport) {
  const LoadArguments parsed = Parse({"--html", "a.html", "--csv", "b.csv", "--json", "-",
                                      "--records", "c.csv", "--title", "Two cores", "--quiet"});
  EXPECT_EQ(parsed.html, "a.html");
  EXPECT_EQ(parsed.csv, "b.csv");
  EXPECT_EQ(parsed.json, "-");
  EXPECT_EQ(parsed.records, "c.csv");
  EXPECT_EQ(parsed.title, "Two cores");
  EXPECT_TRUE(parsed.quiet);
}

TEST(LoadFlagsTest, ReadsTheContentOfCalls) {
  const LoadArguments parsed =
      Parse({"--frames", "46=9,460", "--model", "sbu=0.5,k3hi@1=2", "--label", "kick=1",
             "--priority", "bulk", "--deadline", "0.3", "--arrivals", "constant"});
  ASSERT_EQ(parsed.mix.frames.size(), 2U);
  EXPECT_EQ(parsed.mix.frames[0].value, 46);
  EXPECT_EQ(parsed.mix.frames[0].weight, 9);
  EXPECT_EQ(parsed.mix.frames[1].weight, 1);
  EXPECT_EQ(parsed.mix.models[1].value.name, "k3hi");
  EXPECT_EQ(parsed.mix.models[1].value.version, 1);
  EXPECT_EQ(parsed.mix.models[0].weight, 0.5);
  EXPECT_EQ(parsed.mix.labels[0].interaction_class, "kick");
  EXPECT_EQ(parsed.mix.priority, client::Priority::kBulk);
  EXPECT_EQ(parsed.server.deadline_seconds, 0.3);
  EXPECT_EQ(parsed.arrivals, ArrivalKind::kConstant);
}

TEST(LoadFlagsTest, InvalidMixesNameTheExpectedForm) {
  EXPECT_THAT(std::string(ParseFrames("46=0").status().message()),
              HasSubstr("expected a weight above 0"));
  EXPECT_THAT(std::string(ParseFrames("46,x").status().message()),
              HasSubstr("expected numbers of frames, 1 or more, such as 46=9,460, got \"x\""));
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--callers", "0"},
                                             {"--rate", "1", "--callers", "1"},
                                             {"--seconds", "5", "--calls", "7"},
                                             {"--frames", "none"},
                                             {"--arrivals", "never"},
                                             {"--nonsense"}}) {
    EXPECT_EQ(RunWith(arguments).code, kBadUsage) << arguments[0];
  }
}

TEST(LoadFlagsTest, ReadsLiveSessions) {
  const LoadArguments parsed =
      Parse({"--live", "20,50", "--rate", "25", "--jitter", "15", "--loss", "0.02", "--stall",
             "500", "--in-step", "--delay", "2", "--plan", "5"});
  EXPECT_THAT(parsed.live, ::testing::ElementsAre(20, 50));
  EXPECT_EQ(parsed.LiveRate(), 25);
  EXPECT_EQ(parsed.live_conditions.jitter, std::chrono::milliseconds(15));
  EXPECT_EQ(parsed.live_conditions.loss, 0.02);
  EXPECT_EQ(parsed.live_conditions.stall, std::chrono::milliseconds(500));
  EXPECT_TRUE(parsed.in_step);
  EXPECT_EQ(parsed.live_content.delay_frames, 2);
  EXPECT_EQ(parsed.live_content.plan_frames, 5);
  EXPECT_EQ(Parse({"--live", "1"}).LiveRate(), 30);
}

TEST(LoadFlagsTest, LiveSessionsHaveTheirOwnFlags) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--live", "1", "--callers", "1"},
                                             {"--live", "1", "--frames", "46"},
                                             {"--live", "1", "--csv", "x.csv"},
                                             {"--live", "1", "--delay", "11"},
                                             {"--live", "1", "--leader", "/nowhere/hug.bvh"},
                                             {"--jitter", "5"},
                                             {"--in-step"}}) {
    EXPECT_EQ(RunWith(arguments).code, kBadUsage) << arguments[0] << arguments.back();
  }
  const Ran rates = RunWith({"--live", "1", "--rate", "25,30"});
  EXPECT_EQ(rates.code, kRejected);
  EXPECT_THAT(rates.err, HasSubstr("--rate: expected one rate with --live, got 2"));
  EXPECT_THAT(RunWith({"--live", "1", "--rate", "500"}).err,
              HasSubstr("--rate: expected 1 to 240 with --live, got 500"));
  EXPECT_THAT(RunWith({"--live", "1", "--model", "sbu,k3hi"}).err,
              HasSubstr("--model: expected one model with --live, got 2"));
}

TEST(LoadFlagsTest, GivenFlagsAreListed) {
  CLI::App app;
  LoadArguments parsed;
  AddLoadFlags(&app, &parsed);
  app.parse({"--quiet", "5,6", "--rate"});  // in reverse, as CLI11 reads vectors
  EXPECT_THAT(GivenFlags(app), ::testing::ElementsAre(::testing::Pair("rate", "5,6"),
                                                      ::testing::Pair("quiet", "true")));
}

TEST(LoadProgramTest, HelpListsFlagsAndExitCodes) {
  const Ran help = RunWith({"--help"});
  EXPECT_EQ(help.code, kDone);
  EXPECT_THAT(help.out, HasSubstr("--callers N,..."));
  EXPECT_THAT(help.out, HasSubstr("42  the server rejects the calls"));
  EXPECT_EQ(RunWith({"--version"}).out, "duet-load " DUET_VERSION "\n");
}

TEST(LoadProgramTest, UnreachableServerIsAnError) {
  const Ran ran = RunWith({"--server", "unix:/nowhere/duet.sock", "--deadline", "0.05"});
  EXPECT_EQ(ran.code, kNotAnswered);
  EXPECT_THAT(ran.err, HasSubstr("duet-load: "));
}

TEST(LoadProgramTest, MissingTokenFileIsBadInput) {
  EXPECT_EQ(RunWith({"--token-file", "/nowhere/token"}).code, kRejected);
}

}  // namespace
}  // namespace duet::contrib::load::program
