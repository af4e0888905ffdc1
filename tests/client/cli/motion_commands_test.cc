// inspect, convert and view: the whole program, which never reaches for a server.
#include <string>
#include <vector>

#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json.hpp"
#include "tests/client/cli/program_runner.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_motion.h"

namespace duet::client::cli {
namespace {

using formats::Format;
using nlohmann::json;
using test::LargestDistance;
using test::MakePerson;
using test::ReadTestFile;
using test::WriteTestFile;

class MotionCommandsTest : public ProgramRunner {
 protected:
  MotionCommandsTest() {
    Write("pair.csv", Format::kCsv, {leader_, follower_});
    Write("one.csv", Format::kCsv, {leader_});
    Write("one.bvh", Format::kBvh, {leader_});
    Write("one.npy", Format::kNpy, {leader_});
  }

  void Write(const std::string& name, Format format, const std::vector<motion::Clip>& people) {
    EXPECT_THAT(formats::WritePeople(folder_ / name, format, people, motion::SbuSkeleton()),
                IsOk());
  }

  json RunJson(const Strings& arguments) {
    EXPECT_EQ(Run(arguments), 0) << err() << out();
    return json::parse(out(), nullptr, false);
  }

  motion::Clip Read(const std::string& name, formats::ReadOptions options = {}) {
    absl::StatusOr<motion::Clip> clip = ReadLeader(folder_ / name, options);
    EXPECT_THAT(clip, IsOk());
    return clip.value_or(motion::Clip{});
  }

  const motion::Clip leader_ = MakePerson();
  const motion::Clip follower_ = MakePerson({60, 3, 0, {0, 1.1f, 1.2f}, 30});
};

TEST_F(MotionCommandsTest, InspectPrintsEachSettingAndItsOrigin) {
  ASSERT_EQ(Run({"inspect", Path("one.bvh")}), 0);
  EXPECT_THAT(out(),
              StartsWith(Path("one.bvh") + ": BVH, 1 person, 60 frames, 2.00 s at 30 Hz\n"
                                           "  frame rate  30 Hz  (file: Frame Time 0.0333333)\n"
                                           "  unit        centimetres  (guessed: foot to torso"));
  EXPECT_THAT(out(), AllOf(HasSubstr("  up axis     y-up  (guessed"),
                           HasSubstr("    left_hand       left_hand\n"),
                           HasSubstr("    not used: torso_to_neck"), Not(HasSubstr("\x1b"))));
  ASSERT_EQ(Run({"inspect", Path("one.bvh"), "--metres-per-unit", "0.01", "--up-axis", "y-up",
                 "--frame-rate", "60"}),
            0);
  EXPECT_THAT(out(), AllOf(HasSubstr("frame rate  60 Hz  (given)"),
                           HasSubstr("unit        0.01 m  (given)"),
                           HasSubstr("up axis     y-up  (given)")));
}

TEST_F(MotionCommandsTest, ConvertReadsTheJointsOfAnotherSkeleton) {
  WriteTestFile(folder_ / "arm.json",
                R"({"joint_names": ["left_hand", "left_elbow", "left_shoulder"],
                    "bones": [[1, 0], [2, 1]], "interaction_classes": ["wave"]})");
  ASSERT_EQ(Run({"convert", Path("pair.csv"), "--skeleton", Path("arm.json"), "--out",
                 Path("arms.json")}),
            0)
      << err();
  const json arms = json::parse(ReadTestFile(folder_ / "arms.json"));
  EXPECT_EQ(arms["joint_names"], json({"left_hand", "left_elbow", "left_shoulder"}));
  EXPECT_EQ(arms["bones"], json::parse("[[1, 0], [2, 1]]"));
  EXPECT_EQ(arms["follower"][0].size(), 3u);
  // A motion in JSON is a skeleton, too.
  ASSERT_EQ(Run({"convert", Path("arms.json"), "--skeleton", Path("arms.json"), "--side", "right",
                 "--out", Path("arm.glb")}),
            0)
      << err();
  EXPECT_EQ(Run({"convert", Path("arms.json"), "--out", Path("body.json")}), 42);
  EXPECT_THAT(err(), HasSubstr("expected joints for head, neck, torso"));
  ASSERT_EQ(
      Run({"view", Path("arms.json"), "--skeleton", Path("arms.json"), "--out", Path("arms.html")}),
      0)
      << err();
}

TEST_F(MotionCommandsTest, ConvertNamesWhatIsWrongInASkeleton) {
  const std::pair<const char*, const char*> bad[] = {
      {"no JSON", "skeleton.json: "},
      {R"({"bones": []})", "joint_names"},
      {R"({"joint_names": ["a", "b"], "bones": [[0, 2]]})",
       "bones[0]: expected two indices below 2, got [0,2]"},
      {R"({"joint_names": ["a", "b"], "bones": [[0]]})", "bones[0]: expected two indices"},
      {R"({"joint_names": ["a", "b"], "bones": [[0, -1]]})", "bones[0]: expected two indices"},
      {R"({"joint_names": ["a", "b"], "bones": []})", "bones"},
      {R"({"joint_names": ["a", "a"], "bones": [[0, 1]]})", "joint_names"}};
  for (const auto& [text, message] : bad) {
    WriteTestFile(folder_ / "skeleton.json", text);
    EXPECT_EQ(Run({"convert", Path("one.csv"), "--skeleton", Path("skeleton.json"), "--out",
                   Path("out.json")}),
              42)
        << text;
    EXPECT_THAT(err(), HasSubstr(message)) << text;
  }
  EXPECT_EQ(
      Run({"convert", Path("one.csv"), "--skeleton", Path("no.json"), "--out", Path("out.json")}),
      42);
}

TEST_F(MotionCommandsTest, InspectReadsOneOfTwoPeople) {
  ASSERT_EQ(Run({"inspect", Path("pair.csv")}), 0);
  EXPECT_THAT(out(), AllOf(HasSubstr(": CSV, 2 people, 60 frames"),
                           HasSubstr("\n  frame rate  30 Hz  (file)\n")));
  Write("odd.csv", Format::kCsv, {leader_, follower_});
  WriteTestFile(folder_ / "odd.csv", absl::StrReplaceAll(ReadTestFile(folder_ / "odd.csv"),
                                                         {{"follower.left_hand", "follower.paw"}}));
  EXPECT_EQ(Run({"inspect", Path("odd.csv")}), 0);
  EXPECT_EQ(Run({"inspect", Path("odd.csv"), "--side", "right"}), 42) << out();
  EXPECT_THAT(out(), HasSubstr("    left_hand       missing\n"));
}

TEST_F(MotionCommandsTest, InspectNamesWhatIsMissing) {
  WriteTestFile(folder_ / "odd.bvh",
                absl::StrReplaceAll(ReadTestFile(folder_ / "one.bvh"), {{"left_hand", "paw"}}));
  EXPECT_EQ(Run({"inspect", Path("odd.bvh")}), 42);
  EXPECT_THAT(out(),
              AllOf(HasSubstr("    left_hand       missing\n"),
                    HasSubstr("    right_hand      right_hand\n"), HasSubstr("cannot be read: "),
                    HasSubstr("--joint-map"), Not(HasSubstr("skeleton\n"))));
  ASSERT_EQ(Run({"inspect", Path("odd.bvh"), "--joint-map", "left_hand=paw"}), 0);
  EXPECT_THAT(out(), HasSubstr("    left_hand       paw  (given)\n"));
}

// A name with an escape sequence must not reach the terminal, whether or not its joint is used.
TEST_F(MotionCommandsTest, InspectEscapesControlCharactersInNames) {
  WriteTestFile(folder_ / "odd.bvh", absl::StrReplaceAll(ReadTestFile(folder_ / "one.bvh"),
                                                         {{"torso_to_neck", "\x1b[31mspare"},
                                                          {"left_hand", "\x07paw"}}));
  ASSERT_EQ(Run({"inspect", Path("odd.bvh"), "--joint-map", "left_hand=\x07paw"}), 0);
  EXPECT_THAT(out(), AllOf(HasSubstr("    left_hand       \\x07paw  (given)\n"),
                           HasSubstr("    not used: \\x1b[31mspare"), Not(HasSubstr("\x1b")),
                           Not(HasSubstr("\x07"))));
}

TEST_F(MotionCommandsTest, InspectReadsAFileWithoutAFrameRate) {
  ASSERT_EQ(Run({"inspect", Path("one.npy")}), 0);
  EXPECT_THAT(out(), AllOf(HasSubstr("NPY, 1 person, 60 frames\n"),
                           HasSubstr("frame rate  unknown; specify it with --frame-rate HZ\n"),
                           HasSubstr("unit        metres  (default)\n")));
}

TEST_F(MotionCommandsTest, InspectContinuesAfterAnUnreadableFile) {
  WriteTestFile(folder_ / "empty.bvh", "");
  EXPECT_EQ(Run({"inspect", Path("empty.bvh"), Path("no.csv"), Path("one.csv")}), 42);
  EXPECT_THAT(out(), AllOf(HasSubstr("empty.bvh:1: expected HIERARCHY"),
                           HasSubstr("no.csv: no such file"), HasSubstr("CSV, 1 person")));
}

TEST_F(MotionCommandsTest, EveryReadableFormatConvertsToEveryWritableFormat) {
  const Strings formats = {"csv", "json", "npy", "bvh", "glb", "gltf", "txt"};
  const auto people = [](const std::string& from) { return from == "bvh" ? 1 : 2; };
  for (const std::string& from : formats) {
    const std::string source = people(from) == 1 ? "one.csv" : "pair.csv";
    ASSERT_EQ(Run({"convert", Path(source), "--out", Path("from." + from)}), 0) << err();
    for (const std::string& to : formats) {
      const std::string name = from + "_to." + to;
      const Strings command = {"convert", Path("from." + from), "--frame-rate", "30", "--out",
                               Path(name)};
      if (to == "txt" && people(from) == 1) {
        EXPECT_EQ(Run(command), 42);
        EXPECT_THAT(err(), HasSubstr("SBU text always has two"));
        continue;
      }
      ASSERT_EQ(Run(command), 0) << name << err();
      const bool apart = to == "bvh" && people(from) == 2;
      formats::ReadOptions options;
      options.frame_rate_hz = 30;
      EXPECT_LT(LargestDistance(Read(apart ? from + "_to.leader.bvh" : name, options), leader_),
                0.005f)
          << name;
      if (people(from) == 1) continue;
      options.side = formats::Side::kRight;
      EXPECT_LT(LargestDistance(Read(apart ? from + "_to.follower.bvh" : name, options), follower_),
                0.005f)
          << name;
    }
  }
}

TEST_F(MotionCommandsTest, ConvertTakesOnePersonOrBoth) {
  ASSERT_EQ(Run({"convert", Path("pair.csv"), "--side", "right", "--out", Path("r.bvh")}), 0);
  EXPECT_LT(LargestDistance(Read("r.bvh"), follower_), 1e-4f);
  EXPECT_FALSE(Exists("r.leader.bvh"));
}

TEST_F(MotionCommandsTest, ConvertWritesAPersonOntoARig) {
  WriteTestFile(folder_ / "rig.bvh", absl::StrReplaceAll(ReadTestFile(folder_ / "one.bvh"),
                                                         {{"JOINT left_hand", "JOINT Flipper"}}));
  ASSERT_EQ(Run({"convert", Path("pair.csv"), "--side", "right", "--rig", Path("rig.bvh"),
                 "--rig-joint-map", "left_hand=Flipper", "--out", Path("on_rig.bvh")}),
            0)
      << err();
  EXPECT_THAT(out(), HasSubstr("on the rig of " + Path("rig.bvh")));
  const std::string written = ReadTestFile(folder_ / "on_rig.bvh");
  EXPECT_THAT(written, AllOf(HasSubstr("JOINT Flipper"), Not(HasSubstr("JOINT left_hand"))));
  formats::ReadOptions options;
  options.joint_overrides = {{"left_hand", "Flipper"}};
  EXPECT_LT(LargestDistance(Read("on_rig.bvh", options), follower_), 0.05);
  // Half the size of a unit halves the rig.
  ASSERT_EQ(Run({"convert", Path("pair.csv"), "--side", "right", "--rig", Path("one.bvh"),
                 "--rig-metres-per-unit", "0.005", "--out", Path("half.bvh")}),
            0)
      << err();
  options = {};
  options.metres_per_unit = 0.005;
  EXPECT_GT(LargestDistance(Read("half.bvh", options), follower_), 0.3);
}

TEST_F(MotionCommandsTest, InvalidUseOfARigIsReported) {
  const std::string rig = Path("one.bvh"), crab = Path("crab.bvh");
  WriteTestFile(crab, absl::StrReplaceAll(ReadTestFile(rig), {{"_hand", "_claw"}}));
  const struct {
    Strings more;
    int code;
    const char* message;
  } cases[] = {
      {{"--rig", rig, "--out", Path("a.bvh")}, 42, "--side: expected left or right with --rig"},
      {{"--rig", rig, "--side", "left", "--out", Path("a.csv")}, 2, "expected the format of --rig"},
      {{"--rig", Path("one.csv"), "--side", "left", "--out", Path("a.bvh")},
       2,
       "--rig: expected a .bvh, "},
      {{"--rig-joint-map", "head=Top", "--side", "left", "--out", Path("a.bvh")}, 2, "--rig"},
      {{"--rig", Path("no.bvh"), "--side", "left", "--out", Path("a.bvh")}, 42, "no.bvh"},
      {{"--rig", rig, "--rig-joint-map", "head=Nobody", "--side", "left", "--out", Path("a.bvh")},
       42,
       "Nobody"},
      {{"--rig", crab, "--side", "left", "--out", Path("a.bvh")},
       42,
       "\nSpecify it with --rig-joint-map MODEL_JOINT=RIG_JOINT, or a table of them with"}};
  for (const auto& [more, code, message] : cases) {
    EXPECT_EQ(Run(Strings{"convert", Path("pair.csv")} + more), code) << out();
    EXPECT_THAT(err(), HasSubstr(message));
  }
}

TEST_F(MotionCommandsTest, AGiantIsWarnedOf) {
  for (const char* file : {"one.bvh", "one.csv"}) {
    ASSERT_EQ(Run({"convert", Path(file), "--metres-per-unit", "100", "--out", Path("big.json")}),
              0)
        << err();
    EXPECT_THAT(out(), HasSubstr("warning: size: as the file was read, the distance from foot"
                                 " to "));
  }
  ASSERT_EQ(Run({"convert", Path("one.csv"), "--out", Path("same.json")}), 0);
  EXPECT_THAT(out(), Not(HasSubstr("warning")));
}

TEST_F(MotionCommandsTest, ResampleKeepsTheDurationAndFrameRateChangesIt) {
  ASSERT_EQ(Run({"convert", Path("one.csv"), "--resample", "15", "--out", Path("slow.csv")}), 0);
  const motion::Clip resampled = Read("slow.csv");
  EXPECT_EQ(resampled.frame_rate_hz, 15);
  ASSERT_EQ(resampled.frame_count(), 30);
  EXPECT_EQ(resampled.at(7, 4), leader_.at(14, 4));
  EXPECT_THAT(out(), HasSubstr("resampled from 30 Hz"));

  ASSERT_EQ(Run({"convert", Path("one.csv"), "--frame-rate", "15", "--out", Path("said.csv")}), 0);
  EXPECT_EQ(Read("said.csv").frame_rate_hz, 15);
  EXPECT_EQ(Read("said.csv").frame_count(), 60);
  EXPECT_EQ(Run({"convert", Path("one.csv"), "--resample", "1e5", "--out", Path("x.csv")}), 42);
  EXPECT_THAT(err(), HasSubstr("--resample"));
}

TEST_F(MotionCommandsTest, FormatFlagOverridesTheExtension) {
  WriteTestFile(folder_ / "walk.data", ReadTestFile(folder_ / "one.bvh"));
  EXPECT_EQ(Run({"inspect", Path("walk.data")}), 42);
  EXPECT_THAT(out(), HasSubstr("Specify it with --input-format FORMAT.\n"));
  ASSERT_EQ(Run({"inspect", Path("walk.data"), "--input-format", "bvh"}), 0);
  EXPECT_THAT(out(), HasSubstr(": BVH, 1 person"));
}

TEST_F(MotionCommandsTest, ConvertNeverOverwritesItsInput) {
  EXPECT_EQ(Run({"convert", Path("one.csv"), "--out", Path("one.csv")}), 2);
  EXPECT_THAT(err(), HasSubstr("would replace the file that is read"));
  EXPECT_EQ(Run({"convert", Path("one.csv"), "--rig", Path("one.bvh"), "--out", Path("one.bvh")}),
            2);
  EXPECT_THAT(err(), HasSubstr("would replace the file that is read, " + Path("one.bvh")));
  EXPECT_EQ(Run({"convert", Path("one.csv"), "--out", Path("one.html")}), 2);
  EXPECT_THAT(err(), HasSubstr("expected .glb, .gltf, "));
}

TEST_F(MotionCommandsTest, ViewShowsMotionsSideBySide) {
  ASSERT_EQ(
      Run({"view", Path("one.bvh"), "captured=" + Path("pair.csv"), "--out", Path("view.html")}), 0)
      << err();
  EXPECT_THAT(ReadTestFile(folder_ / "view.html"),
              AllOf(HasSubstr("<title>one, captured</title>"), HasSubstr("\"name\":\"captured\"")));
  EXPECT_THAT(out(), AllOf(HasSubstr("shown     one: " + Path("one.bvh") + " (one person)\n"),
                           HasSubstr("shown     captured: " + Path("pair.csv") + "\n"),
                           HasSubstr("wrote     " + Path("view.html") + "\n")));
  ASSERT_EQ(Run({"view", Path("one.bvh"), "--title", "Tuesday", "--out", Path("view.html")}), 0);
  EXPECT_THAT(ReadTestFile(folder_ / "view.html"),
              AllOf(StartsWith("<!doctype html>"), HasSubstr("<title>Tuesday<")));
  EXPECT_EQ(Run({"view", Path("one.bvh"), "--out", Path("view.csv")}), 2);
  EXPECT_THAT(err(), HasSubstr("expected .html, got \".csv\""));
}

TEST_F(MotionCommandsTest, ViewNamesMotionsByTheirFilesOrTheFlag) {
  ASSERT_EQ(Run({"view", "best=" + Path("one.bvh"), "--out", Path("v.html")}), 0) << err();
  EXPECT_THAT(out(), HasSubstr("shown     best: " + Path("one.bvh") + " (one person)\n"));
  WriteTestFile(folder_ / "a=b.csv", ReadTestFile(folder_ / "one.csv"));
  ASSERT_EQ(Run({"view", Path("a=b.csv"), "--out", Path("v.html")}), 0) << err();
  EXPECT_THAT(out(), HasSubstr("shown     a=b: "));
  EXPECT_EQ(Run({"view", Path("no.csv"), "--out", Path("v.html")}), 42);
  EXPECT_THAT(err(), HasSubstr("no.csv: no such file"));
}

}  // namespace
}  // namespace duet::client::cli
