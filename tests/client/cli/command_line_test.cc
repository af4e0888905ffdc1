#include "client/cli/command_line.h"

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/synthesize_flags.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

using Strings = std::vector<std::string>;

// The text and exit code of a command line that runs no command.
ParsedCommandLine Parse(const Strings& arguments) {
  CommandLine line;
  ParsedCommandLine parsed = line.Parse(arguments);
  EXPECT_EQ(parsed.command, nullptr);
  return parsed;
}

class CommandLineTest : public ::testing::Test {
 protected:
  // The required flags of `duet synthesize` except its labels, and `more`.
  Strings Synthesize(const Strings& more) const {
    Strings arguments = {"synthesize", "--leader", "kick.bvh", "--out", Out("pair.html")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  // The arguments of a valid command line with a label.
  SynthesizeArguments Good(const Strings& more) {
    Strings with_label = {"--label", "kick=1"};
    with_label.insert(with_label.end(), more.begin(), more.end());
    return Arguments(Synthesize(with_label));
  }

  // The arguments of a valid command line.
  static SynthesizeArguments Arguments(const Strings& words) {
    CommandLine line;
    EXPECT_NE(line.Parse(words).command, nullptr);
    FlagSet command;
    SynthesizeArguments arguments;
    AddSynthesizeFlags(&command, &arguments);
    // Without the command's name.
    EXPECT_EQ(command.Parse(Strings(words.begin() + 1, words.end())).error, "");
    return arguments;
  }

  void ExpectUsageError(const Strings& arguments, const std::string& message) {
    const ParsedCommandLine parsed = Parse(arguments);
    EXPECT_EQ(parsed.exit_code, 2);
    EXPECT_THAT(parsed.text, HasSubstr(message));
  }
  void ExpectRefused(const Strings& more, const std::string& message) {
    ExpectUsageError(Synthesize(more), message);
  }

  std::string Out(const std::string& name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(CommandLineTest, VersionAndHelpSucceed) {
  EXPECT_EQ(Parse({"--version"}).exit_code, 0);
  EXPECT_THAT(Parse({"--version"}).text, HasSubstr("duet " DUET_VERSION));
  for (const Strings& arguments :
       {Strings{"--help"}, Strings{"synthesize", "--help"}, Strings{"models", "--help"}}) {
    const ParsedCommandLine parsed = Parse(arguments);
    EXPECT_EQ(parsed.exit_code, 0);
    EXPECT_THAT(parsed.text, HasSubstr("Usage: duet"));
  }
  EXPECT_THAT(Parse({"synthesize", "--help"}).text, HasSubstr("  42  failed"));
}

TEST_F(CommandLineTest, HelpShowsDefaults) {
  const std::string help = Parse({"synthesize", "--help"}).text;
  const std::pair<const char*, const char*> defaults[] = {
      {"--server HOST:PORT", "localhost:50051"},
      {"--timeout SECONDS", "120"},
      {"--wait SECONDS", "5"},
      {"--leader-side left|right", "left"},
      {"--priority bulk|interactive", "interactive"},
      {"--clean-up auto|off|on", "auto"},
      {"--seed SEED", "0"},
      {"--variety VARIETY", "1"},
      {"--candidates COUNT", "1"},
      {"--samples COUNT", "1"}};
  for (const auto& [flag, value] : defaults) {
    // CLI11 2.3 and 2.4 write them differently.
    EXPECT_THAT(help, AnyOf(HasSubstr(absl::StrCat(flag, "=", value)),
                            HasSubstr(absl::StrCat(flag, " [", value, "]"))));
  }
  EXPECT_THAT(help, HasSubstr("else left)"));
}

TEST_F(CommandLineTest, SynthesizeHasDefaults) {
  const SynthesizeArguments arguments = Good({});
  EXPECT_EQ(arguments.leader, "kick.bvh");
  EXPECT_EQ(arguments.leader_side, formats::Side::kLeft);
  ASSERT_THAT(arguments.weights, SizeIs(1));
  EXPECT_EQ(arguments.weights[0].interaction_class, "kick");
  EXPECT_EQ(arguments.model.name, "");
  EXPECT_EQ(arguments.priority, Priority::kInteractive);
  EXPECT_EQ(arguments.seed, 0u);
  EXPECT_EQ(arguments.variety, 1);
  EXPECT_EQ(arguments.candidates, 1);
  EXPECT_EQ(arguments.clean_up, std::nullopt);
  EXPECT_FALSE(arguments.rotations);
  EXPECT_EQ(arguments.samples, 1);
  EXPECT_TRUE(arguments.constraints.empty());
  EXPECT_EQ(arguments.input.frame_rate_hz, std::nullopt);
  EXPECT_EQ(arguments.input.unit, std::nullopt);
  EXPECT_THAT(arguments.outputs, ElementsAre(Out("pair.html")));
}

TEST_F(CommandLineTest, EveryFlagIsRead) {
  const SynthesizeArguments arguments = Good({"--label",
                                              "hug=-0.5",
                                              "--leader-side",
                                              "right",
                                              "--frame-rate",
                                              "30",
                                              "--unit",
                                              "millimetres",
                                              "--up-axis",
                                              "z-up",
                                              "--metres-per-unit",
                                              "0.01",
                                              "--joint-map",
                                              "left_hand=LHand",
                                              "--joint-map",
                                              "right_hand=RHand",
                                              "--joint-map-file",
                                              "rig.txt",
                                              "--model",
                                              "sbu@2",
                                              "--follower-start",
                                              "-0.5,1,2",
                                              "--follower-start-side",
                                              "right",
                                              "--seed",
                                              "18446744073709551610",
                                              "--variety",
                                              "0.25",
                                              "--candidates",
                                              "4",
                                              "--samples",
                                              "6",
                                              "--clean-up",
                                              "off",
                                              "--priority",
                                              "bulk",
                                              "--chunk-frames",
                                              "8",
                                              "--request-id",
                                              "job-7",
                                              "--pin",
                                              "right_hand@40=-0.2,1.3,0.5",
                                              "--pin",
                                              "head@3=0,1.5,0,0.25",
                                              "--out",
                                              Out("pair.bvh"),
                                              "--json",
                                              "--quiet",
                                              "--server",
                                              "h:1",
                                              "--timeout",
                                              "2.5"});
  ASSERT_THAT(arguments.weights, SizeIs(2));
  EXPECT_EQ(arguments.weights[1].weight, -0.5f);
  EXPECT_EQ(arguments.leader_side, formats::Side::kRight);
  EXPECT_EQ(arguments.input.frame_rate_hz, 30);
  EXPECT_EQ(arguments.input.unit, motion::LengthUnit::kMillimetres);
  EXPECT_EQ(arguments.input.up_axis, motion::UpAxis::kZUp);
  EXPECT_EQ(arguments.input.metres_per_unit, 0.01);
  EXPECT_THAT(arguments.input.joints,
              ElementsAre(Pair("left_hand", "LHand"), Pair("right_hand", "RHand")));
  EXPECT_EQ(arguments.input.joint_table, "rig.txt");
  EXPECT_EQ(arguments.model.name, "sbu");
  EXPECT_EQ(arguments.model.version, 2);
  EXPECT_EQ(arguments.follower_start, "-0.5,1,2");
  EXPECT_EQ(arguments.follower_start_side, formats::Side::kRight);
  EXPECT_EQ(arguments.seed, 18446744073709551610u);
  EXPECT_EQ(arguments.variety, 0.25f);
  EXPECT_EQ(arguments.candidates, 4);
  EXPECT_EQ(arguments.samples, 6);
  EXPECT_EQ(arguments.clean_up, false);
  EXPECT_EQ(arguments.priority, Priority::kBulk);
  EXPECT_EQ(arguments.chunk_frames, 8);
  EXPECT_EQ(arguments.request_id, "job-7");
  ASSERT_THAT(arguments.constraints, SizeIs(2));
  EXPECT_EQ(arguments.constraints[0].joint, "right_hand");
  EXPECT_EQ(arguments.constraints[1].softness, 0.25f);
  EXPECT_THAT(arguments.outputs, ElementsAre(Out("pair.html"), Out("pair.bvh")));
  EXPECT_TRUE(arguments.json);
  EXPECT_TRUE(arguments.quiet);
  EXPECT_EQ(arguments.server.address, "h:1");
  EXPECT_EQ(arguments.server.timeout_seconds, 2.5);
}

TEST_F(CommandLineTest, KeyframesReplaceLabels) {
  const SynthesizeArguments arguments =
      Arguments(Synthesize({"--keyframe", "0:kick=1", "--keyframe", "30:kick=0,hug=1"}));
  ASSERT_THAT(arguments.keyframes, SizeIs(2));
  EXPECT_EQ(arguments.keyframes[1].frame, 30);
}

TEST_F(CommandLineTest, KeyframesInBeatsRequireABeat) {
  const SynthesizeArguments arguments =
      Arguments(Synthesize({"--beat", "180,0.25", "--keyframe", "0:kick", "--keyframe", "8b:hug"}));
  EXPECT_EQ(arguments.beat->per_minute, 180);
  EXPECT_EQ(arguments.beat->first_seconds, 0.25);
  EXPECT_EQ(arguments.keyframes[1].beats, 8);
  ExpectRefused({"--keyframe", "0:kick", "--keyframe", "8b:hug"},
                "--keyframe: expected --beat BPM[,OFFSET] with the position 8b in beats, got no "
                "--beat");
  ExpectRefused({"--keyframe", "0:kick", "--beat", "500"},
                "--beat: expected a BPM from 20 to 400, got \"500\"");
  EXPECT_EQ(Good({}).beat, std::nullopt);
  ExpectUsageError({"batch", "leaders", "--beat", "180"}, "--beat");
}

TEST_F(CommandLineTest, MissingFlagIsNamed) {
  ExpectUsageError({}, "A command is required");
  ExpectUsageError({"synthesize", "--label", "kick=1", "--out", Out("pair.html")}, "--leader");
  ExpectUsageError({"synthesize", "--leader", "kick.bvh", "--label", "kick=1"}, "--out");
  ExpectRefused({}, "--label or --keyframe is required");
}

TEST_F(CommandLineTest, ALongerFormOfAFlagIsSuggested) {
  ExpectUsageError({"admin", "models", "--server", "a"},
                   "admin has no flag --server; did you mean --admin-server?");
}

TEST_F(CommandLineTest, ErrorsStateWhatIsExpectedAndGiven) {
  ExpectRefused({"--label", "kick", "--samples", "0"},
                "--samples: expected a whole number from 1 to 1000, got \"0\"");
  ExpectRefused({"--label", "kick", "--wait", "x"},
                "--wait: expected a number from 0 to 86400, got \"x\"");
  ExpectRefused({"--label", "kick", "--priority", "high"},
                "--priority: expected bulk or interactive, got \"high\"");
  ExpectRefused({"--label", "kick", "--request-id", "caf\xc3\xa9"},
                "--request-id: expected 1 to 128 printable ASCII characters without spaces, got "
                "\"caf\\xc3\\xa9\"");
  ExpectUsageError(
      {"live", "--from", "-", "--to", "-", "--label", "kick", "--request-id", "two words"},
      "--request-id: expected 1 to 128");
  ExpectRefused({"--label", "kick", "--timeout"}, "--timeout: expected a value, got none");
  ExpectRefused({"--label", "kick", "--server", "a", "--server", "b"},
                "--server: expected one value, got 2");
  ExpectRefused({"--label", "kick", "--json=maybe"},
                "--json: expected true or false, got \"maybe\"");
  // Comparisons with NaN are false.
  for (const char* flag : {"--wait", "--timeout"}) {
    ExpectRefused({"--label", "kick", flag, "nan"},
                  absl::StrCat(flag, ": expected a number from "));
  }
  ExpectUsageError({"batch", "leaders", "--sample", "nan"},
                   "--sample: expected a number from 0 to 1, got \"nan\"");
  ExpectUsageError({"models", "extra"}, "Unexpected argument \"extra\"");
  ExpectUsageError({"compare", "a.bvh"}, "files: expected at least 2 values, got 1");
  ExpectUsageError({"completion", "tcsh"}, "expected bash, zsh or fish, got \"tcsh\"");
}

TEST_F(CommandLineTest, InvalidValueIsNamed) {
  ExpectUsageError({"dance"}, "There is no command \"dance\"");
  ExpectUsageError({"models", "--frobnicate"}, "--frobnicate");
  ExpectRefused({"--label", "kick="}, "--label: expected CLASS or CLASS=WEIGHT");
  ExpectRefused({"--label", "kick=1", "hug=1"}, "hug=1");
  ExpectRefused({"--keyframe", "kick=1"}, "--keyframe: expected FRAME:CLASS=WEIGHT");
  ExpectRefused({"--label", "kick=1", "--keyframe", "0:kick=1"}, "excludes");
  ExpectRefused({"--label", "kick=1", "--leader-side", "up"},
                "--leader-side: expected left or right, got \"up\"");
  ExpectRefused({"--label", "kick=1", "--unit", "1"}, "--unit: expected metres");
  ExpectRefused({"--label", "kick=1", "--frame-rate", "-15"},
                "--frame-rate: expected a number above 0, got \"-15\"");
  ExpectRefused({"--label", "kick=1", "--metres-per-unit", "inf"},
                "--metres-per-unit: expected a number above 0, got \"inf\"");
  ExpectRefused({"--label", "kick=1", "--timeout", "0"}, "--timeout");
  ExpectRefused({"--label", "kick=1", "--tls-key", "key.pem"}, "--tls-key");
  ExpectRefused({"--label", "kick=1", "--model", "sbu@x"}, "--model: expected NAME");
  ExpectRefused({"--label", "kick=1", "--seed", "-1"}, "--seed: expected a whole number");
  ExpectRefused({"--label", "kick=1", "--variety", "3"},
                "--variety: expected a number from 0 to 2, got \"3\"");
  ExpectRefused({"--label", "kick=1", "--candidates", "0"}, "--candidates");
  ExpectRefused({"--label", "kick=1", "--candidates", "17"}, "--candidates");
  ExpectRefused({"--label", "kick=1", "--pin", "head@3"},
                "--pin: expected JOINT@FRAME=X,Y,Z[,SOFTNESS]");
  ExpectRefused({"--label", "kick=1", "--samples", "0"}, "--samples");
  ExpectRefused({"--label", "kick=1", "--seed", "18446744073709551610", "--samples", "7"},
                "--samples: expected at most 6 with --seed 18446744073709551610, so that no seed "
                "exceeds the largest, got 7");
  ExpectRefused({"--label", "kick=1", "--tls-cert", "a.pem"}, "--tls-key");
}

TEST_F(CommandLineTest, FlagsOfOneFormatAreRejectedWithoutIt) {
  const Strings convert = {"convert", "a.bvh", "--out", Out("a.csv")};
  const auto with = [&convert](const std::string& flag, const std::string& value) {
    Strings arguments = convert;
    arguments.insert(arguments.end(), {flag, value});
    return arguments;
  };
  ExpectUsageError(with("--bvh-unit", "metres"), "--bvh-unit: expected an output FILE.bvh, got ");
  ExpectUsageError(with("--bvh-keys-per-frame", "2"), "--bvh-keys-per-frame: expected an output");
  ExpectRefused({"--label", "kick", "--out", Out("a.glb"), "--bvh-unit", "metres"}, "--bvh-unit");
  // The configuration file holds flags for every command and format.
  CommandLine line;
  EXPECT_EQ(line.Parse(convert, {{"bvh-unit", "metres", "config:1"}}).exit_code, 0);
}

TEST_F(CommandLineTest, FlagsOfAnotherRigNeedOne) {
  for (const char* name : {"up-axis", "metres-per-unit", "joint-map", "joint-map-file"}) {
    const std::string value = name == std::string("up-axis")           ? "y-up"
                              : name == std::string("metres-per-unit") ? "1"
                                                                       : "head=Top";
    ExpectRefused({"--label", "kick", "--out", Out("pair.bvh"), "--follower-rig", "leader",
                   absl::StrCat("--follower-rig-", name), value},
                  absl::StrCat("--follower-rig-", name,
                               ": is only valid with --follower-rig FILE. For the leader's rig, "
                               "use --",
                               name));
  }
}

TEST_F(CommandLineTest, RigRequiresAnOutputFormatWithARig) {
  ExpectRefused(
      {"--label", "kick", "--out", Out("pair.bvh"), "--follower-rig", "rig.csv"},
      "--follower-rig: expected a .bvh, .glb or .gltf and --out FILE in its format, got rig.csv");
  ExpectRefused({"--label", "kick", "--out", Out("pair.csv"), "--follower-rig", "rig.bvh"},
                "got rig.bvh and --out");
}

TEST_F(CommandLineTest, RotationsRequireAnOutputThatHoldsThem) {
  EXPECT_TRUE(Good({"--rotations", "--out", Out("pair.json")}).rotations);
  EXPECT_TRUE(Good({"--rotations", "--out", "-", "--output-format", "json"}).rotations);
  ExpectRefused({"--label", "kick", "--rotations", "--out", Out("pair.glb")},
                "--rotations: expected --out FILE.json, which holds them, got --out ");
}

TEST_F(CommandLineTest, UnwritableOutputsAreRejectedFirst) {
  ExpectRefused({"--label", "kick=1", "--out", Out("pair.fbx")},
                "expected .html, .glb, .gltf, .bvh, .csv, .npy, .json or .txt (SBU text), got "
                "\".fbx\"");
  ExpectRefused({"--label", "kick=1", "--out", Out("no/pair.csv")}, "there is no folder");
  const std::string leader = Out("leader.csv");
  WriteTestFile(leader, "");
  ExpectUsageError({"synthesize", "--leader", leader, "--label", "kick=1", "--out", leader},
                   "would replace the file that is read");
}

TEST_F(CommandLineTest, EachOfSeveralSamplesHasFilesNamedAfterItsSeed) {
  const SynthesizeArguments one = Good({"--seed", "7", "--out", Out("pair.bvh")});
  EXPECT_THAT(SampleOutputs(one, 0), ElementsAre(Out("pair.html"), Out("pair.bvh")));
  const SynthesizeArguments two =
      Good({"--seed", "7", "--samples", "2", "--out", Out("pair.x.bvh")});
  EXPECT_EQ(SeedOf(two, 1), 8u);
  EXPECT_THAT(SampleOutputs(two, 0), ElementsAre(Out("pair.seed7.html"), Out("pair.x.seed7.bvh")));
  EXPECT_THAT(SampleOutputs(two, 1), ElementsAre(Out("pair.seed8.html"), Out("pair.x.seed8.bvh")));
}

TEST_F(CommandLineTest, OutputWithoutAnExtensionIsRejectedByName) {
  ExpectRefused({"--label", "kick=1", "--out", Out("pair"), "--samples", "2"},
                "pair: extension: expected .html");
}

TEST_F(CommandLineTest, NoSampleReplacesTheLeader) {
  const std::string leader = Out("pair.seed8.csv");
  WriteTestFile(leader, "");
  ExpectUsageError({"synthesize", "--leader", leader, "--label", "kick=1", "--out", Out("pair.csv"),
                    "--seed", "7", "--samples", "2"},
                   "would replace the file that is read");
}

TEST_F(CommandLineTest, NoFileOfAPairReplacesAnInput) {
  for (const char* name : {"pair.leader.bvh", "pair.follower.bvh", "pair.follower.glb",
                           "start.json", "rig.glb", "leader.csv"}) {
    WriteTestFile(Out(name), "");
  }
  const auto refused = [this](Strings flags, const std::string& replaced) {
    flags.insert(flags.begin(), {"synthesize", "--label", "kick=1"});
    ExpectUsageError(flags, Out(replaced) + ": would replace the file that is read");
  };
  const std::string leader = Out("leader.csv"), bvh = Out("pair.bvh"), glb = Out("pair.glb");
  refused({"--leader", Out("pair.leader.bvh"), "--out", bvh}, "pair.leader.bvh");
  refused({"--leader", Out("pair.follower.bvh"), "--out", bvh}, "pair.follower.bvh");
  refused({"--leader", leader, "--follower-start", Out("start.json"), "--out", Out("start.json")},
          "start.json");
  refused({"--leader", leader, "--follower-rig", Out("rig.glb"), "--out", Out("rig.glb")},
          "rig.glb");
  refused({"--leader", leader, "--follower-rig", Out("pair.follower.bvh"), "--out", bvh},
          "pair.follower.bvh");
  refused({"--leader", Out("pair.follower.glb"), "--follower-rig", "leader", "--out", glb},
          "pair.follower.glb");
  // Without a rig, the answer to the follower is one file.
  EXPECT_THAT(Arguments({"synthesize", "--label", "kick", "--leader", Out("pair.follower.glb"),
                         "--out", glb})
                  .outputs,
              ElementsAre(glb));
}

}  // namespace
}  // namespace duet::client::cli
