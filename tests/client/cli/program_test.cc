// The whole program against a connection that a test scripts.
#include "client/cli/program.h"

#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_replace.h"
#include "client/mocks/mock_connection.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json.hpp"
#include "tests/client/support/fake_stub.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_certificate.h"

namespace duet::client::cli {
namespace {

using test::ReadTestFile;
using test::ServiceError;
using test::SteppingMotion;
using test::SwayingMotion;
using test::TemporaryFolder;
using test::WriteTestFile;

using ::testing::_;
using ::testing::Return;

constexpr int kFrames = 20;

ModelDetails SbuModel() {
  ModelDetails details;
  details.model.name = "sbu";
  details.model.version = 1;
  details.model.version_labels = {"stable"};
  details.model.is_default = true;
  details.model.interaction_classes = {"kick", "hug"};
  details.model.joint_names = motion::SbuSkeleton().joint_names;
  details.model.bones = motion::SbuSkeleton().bones;
  details.model.root_joint = "torso";
  details.model.frame_rate_hz = 15;
  details.model.window_frames = 46;
  details.model.description = "A test's model.";
  return details;
}

// The follower stands two metres behind the leader.
absl::StatusOr<SynthesisResult> Follow(const SynthesisRequest& request) {
  SynthesisResult result;
  result.pair.leader = request.leader;
  result.pair.follower = request.leader;
  for (motion::Vec3& position : result.pair.follower.poses.all()) position.z -= 2;
  result.model_name = "sbu";
  result.model_version = 1;
  result.window_count = 1;
  result.attempt_count = 1;
  result.request_id = "request-1";
  result.seed = request.seed;
  result.variety = request.variety;
  result.candidates = request.candidates;
  result.cleaned_up = request.clean_up.value_or(false);
  result.timings.first_chunk = absl::Milliseconds(12);
  result.timings.total = absl::Milliseconds(34);
  return result;
}

class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest() {
    leader_.joint_names = motion::SbuSkeleton().joint_names;
    leader_.frame_rate_hz = 15;
    const motion::Poses swaying = SwayingMotion(kFrames, 15);
    leader_.poses = swaying;
    const motion::ClipPair pair{leader_, leader_};
    EXPECT_THAT(formats::WritePair(folder_ / "leader.csv", pair, motion::SbuSkeleton()), IsOk());
    ON_CALL(*connection_, GetModel).WillByDefault(Return(SbuModel()));
    ON_CALL(*connection_, Synthesize)
        .WillByDefault(
            [](const SynthesisRequest& request, const ChunkCallback&) { return Follow(request); });
  }

  int Run(const std::vector<std::string>& arguments) {
    out_.str("");
    err_.str("");
    ProgramEnvironment environment{[this](const ClientOptions& options) {
                                     options_ = options;
                                     return absl::StatusOr<Client>(Client(connection_));
                                   },
                                   &out_, &err_, &in_};
    environment.variables = [this](const std::string& name) {
      const auto found = variables_.find(name);
      return found == variables_.end() ? std::nullopt : std::optional<std::string>(found->second);
    };
    return RunProgram(arguments, environment);
  }

  // duet synthesize --leader leader.csv --label kick=1 ... --out <name>
  int Synthesize(const std::string& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "synthesize", "--leader", Path("leader.csv"), "--out", Path(out), "--label", "kick=1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  TemporaryFolder folder_;
  motion::Clip leader_;
  std::shared_ptr<::testing::NiceMock<MockConnection>> connection_ =
      std::make_shared<::testing::NiceMock<MockConnection>>();
  ClientOptions options_;
  std::map<std::string, std::string> variables_;
  std::istringstream in_;
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(ProgramTest, ListsModelsAsText) {
  EXPECT_CALL(*connection_, ListModels).WillOnce(Return(std::vector{SbuModel().model}));
  EXPECT_EQ(Run({"models", "--server", "duet:1", "--timeout", "3", "--wait", "0.5"}), 0);
  EXPECT_EQ(out_.str(),
            "sbu@1 (stable), default\n"
            "  classes   kick, hug\n"
            "  joints    15, root torso\n"
            "  works at  15 Hz in windows of 46 frames\n"
            "  follower  chooses its own start\n"
            "  answers   one, whatever the seed\n"
            "  about     A test's model.\n");
  EXPECT_EQ(options_.server_address, "duet:1");
  EXPECT_EQ(options_.deadline, absl::Seconds(3));
  EXPECT_EQ(options_.wait, absl::Milliseconds(500));
  EXPECT_FALSE(options_.tls.has_value());
}

TEST_F(ProgramTest, ListsWhichModelsSample) {
  ModelInfo sampler = SbuModel().model;
  sampler.samples = true;
  EXPECT_CALL(*connection_, ListModels).WillRepeatedly(Return(std::vector{sampler}));
  EXPECT_EQ(Run({"models"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("  answers   vary with --seed and --variety\n"));
  EXPECT_EQ(Run({"models", "--json"}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_.str())["models"][0]["samples"], true);
}

TEST_F(ProgramTest, ListsWhichModelsAreFreeBesideTheTerms) {
  ModelInfo model = SbuModel().model;
  model.terms = "Made by the studio.";
  EXPECT_CALL(*connection_, ListModels).WillRepeatedly([&] { return std::vector{model}; });
  EXPECT_EQ(Run({"models"}), 0);
  EXPECT_THAT(out_.str(), EndsWith("\n  terms     Made by the studio.\n"));
  EXPECT_EQ(Run({"models", "--json"}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_.str())["models"][0]["free_for_all_uses"], false);
  model.free_for_all_uses = true;
  EXPECT_EQ(Run({"models"}), 0);
  EXPECT_THAT(out_.str(),
              EndsWith("\n  terms     Made by the studio.\n"
                       "  free      anybody may use the model and its output for any purpose\n"));
  EXPECT_EQ(Run({"models", "--json"}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_.str())["models"][0]["free_for_all_uses"], true);
}

TEST_F(ProgramTest, ListsModelsAsJson) {
  EXPECT_CALL(*connection_, ListModels).WillOnce(Return(std::vector{SbuModel().model}));
  EXPECT_EQ(Run({"models", "--json"}), 0);
  const nlohmann::json json = nlohmann::json::parse(out_.str());
  ASSERT_EQ(json["models"].size(), 1u);
  const nlohmann::json& model = json["models"][0];
  EXPECT_EQ(model["name"], "sbu");
  EXPECT_EQ(model["interaction_classes"], (std::vector<std::string>{"kick", "hug"}));
  EXPECT_EQ(model["bones"].size(), 14u);
}

TEST_F(ProgramTest, WritesEveryKindOfOutput) {
  EXPECT_EQ(Synthesize("pair.html", {"--out", Path("pair.bvh"), "--out", Path("pair.csv"), "--out",
                                     Path("pair.npy"), "--out", Path("pair.json")}),
            0)
      << err_.str();
  for (const char* name :
       {"pair.html", "pair.leader.bvh", "pair.follower.bvh", "pair.csv", "pair.npy", "pair.json"}) {
    EXPECT_TRUE(Exists(name)) << name;
    EXPECT_THAT(out_.str(), HasSubstr(Path(name)));
  }
  EXPECT_THAT(ReadTestFile(folder_ / "pair.html"),
              AllOf(StartsWith("<!doctype html>"), HasSubstr("\"kick\"")));
}

TEST_F(ProgramTest, TheWrittenFollowerIsTheSynthesisedOne) {
  ASSERT_EQ(Synthesize("pair.csv"), 0) << err_.str();
  formats::ReadOptions options;
  options.side = formats::Side::kRight;
  const absl::StatusOr<motion::Clip> follower = ReadLeader(folder_ / "pair.csv", options);
  ASSERT_THAT(follower, IsOk());
  ASSERT_EQ(follower->frame_count(), kFrames);
  EXPECT_NEAR(follower->at(3, 0).z, leader_.at(3, 0).z - 2, 1e-5);
}

TEST_F(ProgramTest, WritesTheFollowersRotationsToJson) {
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce([&](const SynthesisRequest& request, const ChunkCallback&) {
        EXPECT_TRUE(request.rotations);
        SynthesisResult result = *Follow(request);
        result.rotations.emplace();
        result.rotations->rig = {{"torso", -1, {}, 2}};
        result.rotations->rotations.assign(kFrames, {0, 1, 0, 0});
        return result;
      });
  ASSERT_EQ(Synthesize("pair.json", {"--rotations"}), 0) << err_.str();
  const auto document = nlohmann::json::parse(ReadTestFile(folder_ / "pair.json"));
  EXPECT_EQ(document["rig"][0]["name"], "torso");
  ASSERT_EQ(document["rotations"].size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(document["rotations"][3], nlohmann::json::parse("[[0.0, 1.0, 0.0, 0.0]]"));
}

// The hierarchy of a BVH, down to where the motion begins.
std::string HierarchyOf(const std::filesystem::path& file) {
  const std::string text = ReadTestFile(file);
  return text.substr(0, text.find("MOTION"));
}

TEST_F(ProgramTest, WritesTheFollowerOnTheLeadersRig) {
  motion::Clip slower = leader_;
  formats::WriteOptions metres;
  metres.bvh_metres_per_unit = 1;
  ASSERT_THAT(
      formats::WritePair(folder_ / "rig.bvh", {slower, slower}, motion::SbuSkeleton(), metres),
      IsOk());
  ASSERT_EQ(Run({"synthesize", "--leader", Path("rig.leader.bvh"), "--label", "kick=1",
                 "--follower-rig", "leader", "--out", Path("pair.bvh"), "--out", Path("pair.glb")}),
            0)
      << err_.str();
  EXPECT_EQ(HierarchyOf(folder_ / "pair.follower.bvh"), HierarchyOf(folder_ / "rig.leader.bvh"));
  for (const char* file : {"pair.leader.bvh", "pair.follower.bvh"}) {
    formats::ReadOptions options;
    retargeting::ReadingReport report;
    options.report = &report;
    ASSERT_THAT(formats::ReadLeader(folder_ / file, options).status(), IsOk());
    EXPECT_EQ(report.unit->value, "metres") << file << ": both in one unit";
  }
  EXPECT_THAT(out_.str(), HasSubstr("both BVH files have the unit of the rig, 1 m"));
  EXPECT_TRUE(Exists("pair.glb"));
  // Another's rig, for a leader without one.
  ASSERT_EQ(Synthesize("other.bvh", {"--follower-rig", Path("rig.leader.bvh")}), 0) << err_.str();
  EXPECT_EQ(HierarchyOf(folder_ / "other.follower.bvh"), HierarchyOf(folder_ / "rig.leader.bvh"));
}

TEST_F(ProgramTest, AGuessedUnitOfTheFollowersRigIsNoted) {
  formats::WriteOptions unit;
  unit.bvh_metres_per_unit = 0.0175;  // legs of 60 units
  const motion::ClipPair pair{leader_, leader_};
  ASSERT_THAT(formats::WritePair(folder_ / "small.bvh", pair, motion::SbuSkeleton(), unit), IsOk());
  const std::string rig = Path("small.leader.bvh");
  ASSERT_EQ(Synthesize("a.bvh", {"--follower-rig", rig}), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("follower's rig: warning: unit: a guess"));
  ASSERT_EQ(Synthesize("b.bvh", {"--follower-rig", rig, "--follower-rig-metres-per-unit", "0.0175",
                                 "--follower-rig-up-axis", "y-up"}),
            0)
      << err_.str();
  EXPECT_THAT(out_.str(), Not(HasSubstr("a guess")));
  EXPECT_NE(ReadTestFile(folder_ / "a.follower.bvh"), ReadTestFile(folder_ / "b.follower.bvh"));
}

TEST_F(ProgramTest, WritesTheFollowerOnAGltfRigBesideThePair) {
  const motion::ClipPair pair{leader_, leader_};
  ASSERT_THAT(formats::WritePair(folder_ / "rig.glb", pair, motion::SbuSkeleton()), IsOk());
  ASSERT_EQ(Synthesize("pair.gltf", {"--follower-rig", Path("rig.glb")}), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr(Path("pair.follower.gltf")));
  EXPECT_TRUE(Exists("pair.gltf") && Exists("pair.follower.gltf"));
}

TEST_F(ProgramTest, LevelsATiltedLeaderIfTheEvidenceIsStrong) {
  const motion::Vec3 up = {0, 1, 0.2f};
  const motion::Clip tilted{leader_.joint_names, 15, test::Tilted(test::TurningMotion(15), up)};
  ASSERT_THAT(formats::WritePair(folder_ / "tilted.csv", {tilted, tilted}, motion::SbuSkeleton()),
              IsOk());
  std::optional<motion::Vec3> sent;
  EXPECT_CALL(*connection_, Synthesize)
      .WillRepeatedly([&](const SynthesisRequest& request, const ChunkCallback&) {
        sent = request.up;
        return Follow(request);
      });
  const auto run = [&](const std::string& leader, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"synthesize", "--leader", Path(leader), "--label", "kick", "--out",
                                 Path("pair.json")});
    EXPECT_EQ(Run(flags), 0) << err_.str();
  };
  run("tilted.csv", {});
  ASSERT_TRUE(sent.has_value());
  EXPECT_LT(Distance(*sent, up / Norm(up)), 0.03f);
  EXPECT_THAT(out_.str(), HasSubstr("          levelled: tilted by 11."));
  run("tilted.csv", {"--json"});
  EXPECT_NEAR(nlohmann::json::parse(out_.str())["up"][2], 0.196, 0.02);
  run("tilted.csv", {"--level", "off"});
  EXPECT_EQ(sent, std::nullopt);
  EXPECT_THAT(out_.str(), Not(HasSubstr("levelled")));
  run("leader.csv", {"--level", "auto"});
  EXPECT_EQ(sent, std::nullopt);
  EXPECT_THAT(out_.str(), HasSubstr("not levelled: "));
  run("leader.csv", {"--level", "0.1,1,0"});
  EXPECT_EQ(sent, (motion::Vec3{0.1f, 1, 0}));
  EXPECT_THAT(out_.str(), HasSubstr("levelled: tilted by 5.7 degrees, as --level states"));
}

TEST_F(ProgramTest, RejectsAVerticalThatIsFarFromYUp) {
  EXPECT_EQ(Synthesize("pair.json", {"--level", "1,0,0"}), 2);
  EXPECT_THAT(err_.str(), HasSubstr("--level: expected auto, off or X,Y,Z less than 45 degrees"));
}

TEST_F(ProgramTest, SendsTheValuesOfTheFlags) {
  SynthesisRequest sent;
  EXPECT_CALL(*connection_, GetModel(Field(&ModelChoice::name, "sbu")));
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce([&](const SynthesisRequest& request, const ChunkCallback&) {
        sent = request;
        return Follow(request);
      });
  ASSERT_EQ(Synthesize("pair.html", {"--label",
                                     "hug=-0.5",
                                     "--model",
                                     "sbu:stable",
                                     "--priority",
                                     "bulk",
                                     "--follower-start",
                                     "1,1.1,-2",
                                     "--chunk-frames",
                                     "8",
                                     "--partner-direction",
                                     "1,0,-1",
                                     "--request-id",
                                     "job-7",
                                     "--frame-rate",
                                     "30",
                                     "--seed",
                                     "7",
                                     "--variety",
                                     "0.25",
                                     "--candidates",
                                     "4",
                                     "--clean-up",
                                     "on"}),
            0)
      << err_.str();
  ASSERT_EQ(sent.weights.size(), 2u);
  EXPECT_EQ(sent.weights[1].interaction_class, "hug");
  EXPECT_EQ(sent.weights[1].weight, -0.5f);
  EXPECT_EQ(sent.model.version_label, "stable");
  EXPECT_EQ(sent.priority, Priority::kBulk);
  ASSERT_TRUE(sent.follower_start.has_value());
  EXPECT_EQ(std::get<motion::Vec3>(*sent.follower_start), (motion::Vec3{1, 1.1f, -2}));
  EXPECT_EQ(sent.partner_direction, (motion::Vec3{1, 0, -1}));
  EXPECT_EQ(sent.seed, 7u);
  EXPECT_EQ(sent.variety, 0.25f);
  EXPECT_EQ(sent.candidates, 4);
  EXPECT_EQ(sent.clean_up, true);
  EXPECT_EQ(sent.chunk_frames, 8);
  EXPECT_EQ(sent.request_id, "job-7");
  EXPECT_EQ(sent.leader.frame_rate_hz, 30);
  ASSERT_EQ(sent.leader.frame_count(), kFrames);
  EXPECT_NEAR(sent.leader.at(5, 2).y, leader_.at(5, 2).y, 1e-5);
}

TEST_F(ProgramTest, FollowerStartsAsTheOtherPersonOfTheLeadersFile) {
  motion::ClipPair pair{leader_, leader_};
  for (motion::Vec3& position : pair.follower.poses.all()) position.x += 3;
  ASSERT_THAT(formats::WritePair(folder_ / "leader.csv", pair, motion::SbuSkeleton()), IsOk());
  SynthesisRequest sent;
  EXPECT_CALL(*connection_, Synthesize)
      .WillRepeatedly([&](const SynthesisRequest& request, const ChunkCallback&) {
        sent = request;
        return Follow(request);
      });
  ASSERT_EQ(Synthesize("pair.html", {"--follower-start", Path("leader.csv")}), 0) << err_.str();
  const auto& other = std::get<std::vector<motion::Vec3>>(*sent.follower_start);
  ASSERT_EQ(other.size(), 15u);
  EXPECT_NEAR(other[0].x, leader_.at(0, 0).x + 3, 1e-5);

  ASSERT_EQ(Synthesize("pair.html",
                       {"--follower-start", Path("leader.csv"), "--follower-start-side", "left"}),
            0)
      << err_.str();
  const auto& same = std::get<std::vector<motion::Vec3>>(*sent.follower_start);
  EXPECT_NEAR(same[0].x, leader_.at(0, 0).x, 1e-5);
}

TEST_F(ProgramTest, PrintsASummaryAsText) {
  ASSERT_EQ(Synthesize("pair.html", {"--label", "hug=0.5"}), 0);
  EXPECT_THAT(out_.str(),
              HasSubstr("leader    " + Path("leader.csv") + ": 20 frames, 1.33 s at 15 Hz\n"));
  EXPECT_THAT(out_.str(), HasSubstr("reaction  kick 1, hug 0.5\n"));
  EXPECT_THAT(out_.str(), HasSubstr("follower  from sbu@1 in 34 ms, first frames after 12 ms"));
  EXPECT_THAT(out_.str(), HasSubstr("wrote     " + Path("pair.html") + "\n"));
  EXPECT_THAT(out_.str(), Not(HasSubstr("cleaned up")));
  ASSERT_EQ(Synthesize("pair.html", {"--clean-up", "on"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("          cleaned up\n"));
}

TEST_F(ProgramTest, PinsAreSentAndWhatRemainsIsReported) {
  SynthesisRequest sent;
  EXPECT_CALL(*connection_, Synthesize)
      .WillRepeatedly([&](const SynthesisRequest& request, const ChunkCallback&) {
        sent = request;
        absl::StatusOr<SynthesisResult> result = Follow(request);
        result->constraint_metres = {0.004f, 0.123f};
        return result;
      });
  const std::vector<std::string> pins = {"--pin", "head@3=0,1.5,-2", "--pin",
                                         "right_hand@7=1,1,1,0.5"};
  ASSERT_EQ(Synthesize("pair.html", pins), 0) << err_.str();
  ASSERT_EQ(sent.constraints.size(), 2u);
  EXPECT_EQ(sent.constraints[0].joint, "head");
  EXPECT_EQ(sent.constraints[0].position, (motion::Vec3{0, 1.5f, -2}));
  EXPECT_EQ(sent.constraints[1].softness, 0.5f);
  EXPECT_THAT(out_.str(),
              HasSubstr("          pins: 1 reached, right_hand in frame 7 is 12.3 cm away\n"));

  std::vector<std::string> json_flags = pins;
  json_flags.push_back("--json");
  out_.str("");
  ASSERT_EQ(Synthesize("pair.html", json_flags), 0);
  const nlohmann::json json = nlohmann::json::parse(out_.str());
  EXPECT_EQ(json["constraints"][1]["joint_name"], "right_hand");
  EXPECT_EQ(json["constraints"][1]["frame"], 7);
  EXPECT_EQ(json["constraints"][1]["softness"], 0.5);
  EXPECT_NEAR(json["constraints"][1]["remaining_metres"].get<double>(), 0.123, 1e-6);
}

TEST_F(ProgramTest, PrintsASummaryAsJson) {
  ASSERT_EQ(Synthesize("pair.html", {"--json"}), 0);
  const nlohmann::json json = nlohmann::json::parse(out_.str());
  EXPECT_EQ(json["frames"], kFrames);
  EXPECT_EQ(json["model"]["name"], "sbu");
  EXPECT_EQ(json["weights"]["kick"], 1);
  EXPECT_EQ(json["seed"], 0);
  EXPECT_EQ(json["variety"], 1);
  EXPECT_EQ(json["candidates"], 1);
  EXPECT_EQ(json["cleaned_up"], false);
  EXPECT_FALSE(json.contains("constraints"));
  EXPECT_EQ(json["seconds"]["total"], 0.034);
  EXPECT_EQ(json["files"], std::vector<std::string>{Path("pair.html")});
}

// A leader who steps every half second, and a follower who does so 0.1 s later.
class BeatReportTest : public ProgramTest {
 protected:
  static constexpr int kRate = 50;

  BeatReportTest() {
    leader_.frame_rate_hz = kRate;
    leader_.poses = SteppingMotion(Steps(0), 6 * kRate, kRate);
    const motion::ClipPair pair{leader_, leader_};
    EXPECT_THAT(formats::WritePair(folder_ / "leader.csv", pair, motion::SbuSkeleton()), IsOk());
    ON_CALL(*connection_, Synthesize)
        .WillByDefault([](const SynthesisRequest& request, const ChunkCallback&) {
          absl::StatusOr<SynthesisResult> result = Follow(request);
          result->pair.follower.poses = SteppingMotion(Steps(0.1), 6 * kRate, kRate);
          return result;
        });
  }

  // The times of nine steps.
  static std::vector<double> Steps(double delay) {
    std::vector<double> steps;
    for (int i = 2; i < 11; ++i) steps.push_back(0.5 * i + delay);
    return steps;
  }

  nlohmann::json Beat(const std::string& beat) {
    EXPECT_EQ(Synthesize("pair.csv", {"--json", "--frame-rate", "50", "--beat", beat}), 0)
        << err_.str();
    return nlohmann::json::parse(out_.str())["beat"];
  }
};

// A step is found where the foot's speed, 1 m/s, falls below 0.3 m/s after the noise filter: some
// frames after the foot stops.
constexpr double kFoundLate = 70, kDelay = 100, kTolerance = 15;  // ms

TEST_F(BeatReportTest, MeasuresTheStepsOfBoth) {
  const nlohmann::json beat = Beat("120");
  EXPECT_EQ(beat["bpm"], 120);
  EXPECT_EQ(beat["offset_seconds"], 0);
  EXPECT_EQ(beat["leader"]["steps"], 9);
  EXPECT_EQ(beat["follower"]["steps"], 9);
  EXPECT_NEAR(beat["leader"]["mean_distance_ms"], kFoundLate, kTolerance);
  EXPECT_NEAR(beat["follower"]["mean_distance_ms"], kDelay + kFoundLate, kTolerance);
  EXPECT_LT(beat["leader"]["spread_ms"], 5);
  EXPECT_FALSE(beat.contains("note"));
}

TEST_F(BeatReportTest, OffsetMovesTheBeats) {
  const nlohmann::json beat = Beat("120,0.1");
  EXPECT_NEAR(beat["follower"]["mean_distance_ms"], kFoundLate, kTolerance);
  EXPECT_NEAR(beat["leader"]["mean_distance_ms"], kDelay - kFoundLate, kTolerance);
}

TEST_F(BeatReportTest, StepsBeforeTheMusicDoNotCount) {
  const nlohmann::json beat = Beat("120,3");
  EXPECT_EQ(beat["leader"]["steps"], 5);  // from 3 s
  EXPECT_NEAR(beat["leader"]["mean_distance_ms"], kFoundLate, kTolerance);
}

TEST_F(BeatReportTest, IsPartOfTheSummary) {
  ASSERT_EQ(Synthesize("pair.html", {"--frame-rate", "50", "--beat", "120,0.5"}), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("beat      120 BPM, first beat at 0.50 s\n"
                                    "          leader: 9 steps, "));
  EXPECT_THAT(out_.str(), HasSubstr("          follower: 9 steps, "));
  EXPECT_THAT(out_.str(), HasSubstr(" ms from the nearest beat on average, spread "));
  EXPECT_THAT(out_.str(), HasSubstr("          steps that ignore the beat: 125 ms\n"));
  EXPECT_THAT(ReadTestFile(folder_ / "pair.html"),
              HasSubstr("\"beat\":{\"bpm\":120.0,\"offset\":0.5}"));
}

TEST_F(BeatReportTest, EverySampleHasItsOwn) {
  ASSERT_EQ(
      Synthesize("pair.csv", {"--frame-rate", "50", "--beat", "120", "--samples", "2", "--json"}),
      0)
      << err_.str();
  const nlohmann::json json = nlohmann::json::parse(out_.str());
  for (const nlohmann::json& sample : json["samples"]) {
    EXPECT_EQ(sample["beat"]["follower"]["steps"], 9);
  }
}

TEST_F(BeatReportTest, StandingPersonHasNoSteps) {
  ON_CALL(*connection_, Synthesize)
      .WillByDefault([](const SynthesisRequest& request, const ChunkCallback&) {
        absl::StatusOr<SynthesisResult> result = Follow(request);
        result->pair.follower.poses = SteppingMotion({}, 6 * kRate, kRate);
        return result;
      });
  ASSERT_EQ(Synthesize("pair.csv", {"--frame-rate", "50", "--beat", "120"}), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("          follower: no steps\n"));
  EXPECT_TRUE(Beat("120")["follower"]["mean_distance_ms"].is_null());
}

TEST_F(BeatReportTest, ModelWithoutFeetIsReported) {
  ModelDetails details = SbuModel();
  for (std::string& joint : details.model.joint_names) {
    if (joint == "left_foot") joint = "left_paw";
  }
  ON_CALL(*connection_, GetModel).WillByDefault(Return(details));
  const std::vector<std::string> flags = {"--frame-rate", "50",          "--beat",
                                          "120",          "--joint-map", "left_paw=left_foot"};
  ASSERT_EQ(Synthesize("pair.json", flags), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("          cannot find steps: the model has no feet"));
  std::vector<std::string> json = flags;
  json.push_back("--json");
  ASSERT_EQ(Synthesize("pair.json", json), 0) << err_.str();
  const nlohmann::json beat = nlohmann::json::parse(out_.str())["beat"];
  EXPECT_TRUE(beat["leader"].is_null());
  EXPECT_THAT(beat["note"].get<std::string>(), HasSubstr("no feet"));
}

TEST_F(ProgramTest, SummaryWithoutABeatDoesNotMentionIt) {
  ASSERT_EQ(Synthesize("pair.html"), 0);
  EXPECT_THAT(out_.str(), Not(HasSubstr("beat")));
  EXPECT_THAT(ReadTestFile(folder_ / "pair.html"), Not(HasSubstr("\"beat\":")));
  ASSERT_EQ(Synthesize("pair.html", {"--json"}), 0);
  EXPECT_FALSE(nlohmann::json::parse(out_.str()).contains("beat"));
}

TEST_F(ProgramTest, KeyframesInBeatsAreSentAsFrames) {
  SynthesisRequest sent;
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce([&](const SynthesisRequest& request, const ChunkCallback&) {
        sent = request;
        return Follow(request);
      });
  ASSERT_EQ(Run({"synthesize", "--leader", Path("leader.csv"), "--frame-rate", "15", "--out",
                 Path("pair.html"), "--beat", "120,0.2", "--keyframe", "0:kick", "--keyframe",
                 "2b:hug=0.5"}),
            0)
      << err_.str();
  ASSERT_EQ(sent.keyframes.size(), 2u);
  EXPECT_EQ(sent.keyframes[1].frame, 18);  // at 1.2 s
  EXPECT_THAT(out_.str(), HasSubstr("reaction  at frame 0 kick 1; at frame 18 hug 0.5\n"));
}

TEST_F(ProgramTest, EachSampleIsACallWithItsOwnFiles) {
  std::vector<uint64_t> seeds;
  EXPECT_CALL(*connection_, Synthesize)
      .Times(3)
      .WillRepeatedly([&](const SynthesisRequest& request, const ChunkCallback&) {
        seeds.push_back(request.seed);
        absl::StatusOr<SynthesisResult> result = Follow(request);
        for (motion::Vec3& p : result->pair.follower.poses.all()) {
          p.x += static_cast<float>(request.seed);
        }
        return result;
      });
  ASSERT_EQ(Synthesize("pair.csv", {"--seed", "7", "--samples", "3", "--out", Path("pair.bvh")}), 0)
      << err_.str();
  EXPECT_THAT(seeds, ::testing::ElementsAre(7, 8, 9));
  EXPECT_FALSE(Exists("pair.csv"));
  formats::ReadOptions options;
  options.side = formats::Side::kRight;
  for (int seed : {7, 8, 9}) {
    const std::string stem = "pair.seed" + std::to_string(seed);
    EXPECT_TRUE(Exists(stem + ".leader.bvh"));
    EXPECT_TRUE(Exists(stem + ".follower.bvh"));
    EXPECT_THAT(out_.str(), HasSubstr(Path(stem + ".csv")));
    const absl::StatusOr<motion::Clip> follower = ReadLeader(folder_ / (stem + ".csv"), options);
    ASSERT_THAT(follower, IsOk());
    EXPECT_NEAR(follower->at(3, 0).x, leader_.at(3, 0).x + static_cast<float>(seed), 1e-4);
  }
}

TEST_F(ProgramTest, SeveralSamplesAreAJsonList) {
  ASSERT_EQ(Synthesize("pair.csv", {"--samples", "2", "--json"}), 0) << err_.str();
  const nlohmann::json json = nlohmann::json::parse(out_.str());
  ASSERT_EQ(json["samples"].size(), 2u);
  EXPECT_EQ(json["samples"][1]["seed"], 1);
  EXPECT_EQ(json["samples"][1]["files"], std::vector<std::string>{Path("pair.seed1.csv")});
}

TEST_F(ProgramTest, FailedSampleEndsTheCommandAndKeepsEarlierSamples) {
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce(
          [](const SynthesisRequest& request, const ChunkCallback&) { return Follow(request); })
      .WillOnce(Return(absl::UnavailableError("away")));
  EXPECT_EQ(Synthesize("pair.csv", {"--samples", "3"}), 1);
  EXPECT_TRUE(Exists("pair.seed0.csv"));
  EXPECT_FALSE(Exists("pair.seed1.csv"));
}

TEST_F(ProgramTest, PrintsSeedAndVarietyOfAModelThatSamples) {
  ASSERT_EQ(Synthesize("pair.html", {"--seed", "7"}), 0);
  EXPECT_THAT(out_.str(), Not(HasSubstr("seed")));
  ModelDetails details = SbuModel();
  details.model.samples = true;
  EXPECT_CALL(*connection_, GetModel).WillRepeatedly(Return(details));
  ASSERT_EQ(Synthesize("pair.html", {"--seed", "7", "--candidates", "4"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("          seed 7, variety 1, best of 4 candidates\n"));
  ASSERT_EQ(Synthesize("pair.html", {"--seed", "7", "--variety", "0.5"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("          seed 7, variety 0.5\n"));
  EXPECT_THAT(ReadTestFile(folder_ / "pair.html"), HasSubstr("seed 7"));
}

TEST_F(ProgramTest, PrintsUnfamiliarityIfTheServerReportsIt) {
  ASSERT_EQ(Synthesize("pair.csv", {"--json"}), 0);
  EXPECT_FALSE(nlohmann::json::parse(out_.str()).contains("unfamiliarity"));
  EXPECT_CALL(*connection_, Synthesize)
      .WillRepeatedly([](const SynthesisRequest& request, const ChunkCallback&) {
        absl::StatusOr<SynthesisResult> result = Follow(request);
        result->unfamiliarity = 1.25;
        return result;
      });
  ASSERT_EQ(Synthesize("pair.csv", {"--json"}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_.str())["unfamiliarity"], 1.25);
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out_.str(), HasSubstr("          unfamiliarity 1.25 (1: as the farthest tenth"));
  EXPECT_THAT(out_.str(), Not(HasSubstr("unlike")));
}

TEST_F(ProgramTest, PrintsTheGradeIfTheServerReportsIt) {
  ASSERT_EQ(Synthesize("pair.csv", {"--json"}), 0);
  EXPECT_FALSE(nlohmann::json::parse(out_.str()).contains("grade"));
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out_.str(), Not(HasSubstr("graded")));
  MotionGrade grade{0, 0.21f, 0.45f, 0.002f, {}};
  EXPECT_CALL(*connection_, Synthesize)
      .WillRepeatedly([&grade](const SynthesisRequest& request, const ChunkCallback&) {
        absl::StatusOr<SynthesisResult> result = Follow(request);
        result->grade = grade;
        return result;
      });
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out_.str(), HasSubstr("          graded: twisted 0 %, both feet move 21 % (leader 45 "
                                    "%), overlapping < 1 %\n"));
  EXPECT_THAT(out_.str(), Not(HasSubstr("in frames")));
  grade.overlapping = 0.35f;
  grade.bad_runs = {{0, 1}, {3, 2}, {6, 1}, {8, 1}, {10, 1}, {12, 1}};
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out_.str(),
              HasSubstr("          twisted or overlapping in frames 0, 3-4, 6, 8, 10, ...\n"));
  ASSERT_EQ(Synthesize("pair.csv", {"--json"}), 0);
  const nlohmann::json json = nlohmann::json::parse(out_.str())["grade"];
  EXPECT_EQ(json["twisted"], 0);
  EXPECT_EQ(json["skating"], 0.21);
  EXPECT_EQ(json["leader_skating"], 0.45);
  EXPECT_EQ(json["overlapping"], 0.35);
  EXPECT_EQ(json["bad_runs"].size(), 6u);
  EXPECT_EQ(json["bad_runs"][1], (nlohmann::json{{"first_frame", 3}, {"frame_count", 2}}));
}

TEST_F(ProgramTest, WarnsAboutAnUnfamiliarLeader) {
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce([](const SynthesisRequest& request, const ChunkCallback&) {
        absl::StatusOr<SynthesisResult> result = Follow(request);
        result->unfamiliarity = 1.75;
        return result;
      });
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out_.str(), HasSubstr("differs from those that the model was trained on"));
}

TEST_F(ProgramTest, QuietPrintsNothing) {
  ASSERT_EQ(Synthesize("pair.html", {"--quiet"}), 0);
  EXPECT_EQ(out_.str() + err_.str(), "");
}

TEST_F(ProgramTest, SynthesizesBetweenPipes) {
  in_.str(ReadTestFile(folder_ / "leader.csv"));
  ASSERT_EQ(Run({"synthesize", "--leader", "-", "--input-format", "csv", "--label", "kick=1",
                 "--out", "-", "--output-format", "csv"}),
            0)
      << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr("wrote     -\n"));
  WriteTestFile(folder_ / "piped.csv", out_.str());
  formats::ReadOptions options;
  options.side = formats::Side::kRight;
  const absl::StatusOr<motion::Clip> follower = ReadLeader(folder_ / "piped.csv", options);
  ASSERT_THAT(follower, IsOk());
  EXPECT_NEAR(follower->at(3, 0).z, leader_.at(3, 0).z - 2, 1e-5);
  ASSERT_EQ(Run({"synthesize", "--leader", Path("leader.csv"), "--label", "kick=1", "--quiet",
                 "--out", "-", "--output-format", "html"}),
            0);
  EXPECT_THAT(out_.str(), StartsWith("<!doctype html>"));
  EXPECT_EQ(err_.str(), "");
}

TEST_F(ProgramTest, InvalidUseOfPipesMakesNoCall) {
  EXPECT_CALL(*connection_, GetModel).Times(0);
  const auto refused = [this](int code, const std::vector<std::string>& more,
                              const std::string& message) {
    std::vector<std::string> arguments = {"synthesize", "--label", "kick=1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(Run(arguments), code) << message;
    EXPECT_THAT(err_.str(), HasSubstr(message));
  };
  refused(42, {"--leader", "-", "--out", Path("a.csv")}, "standard input: format");
  refused(2, {"--leader", Path("leader.csv"), "--out", "-"}, "--output-format");
  refused(2, {"--leader", Path("leader.csv"), "--out", "-", "--output-format", "bvh"},
          "bvh cannot be used with --out -");
  refused(
      2, {"--leader", Path("leader.csv"), "--out", "-", "--output-format", "csv", "--samples", "2"},
      "each answer needs a file");
}

TEST_F(ProgramTest, UnknownClassIsRejectedWithASuggestion) {
  EXPECT_CALL(*connection_, Synthesize).Times(0);
  EXPECT_EQ(Synthesize("pair.html", {"--label", "hugg=1"}), 42);
  EXPECT_THAT(err_.str(),
              HasSubstr("--label: class: expected one of sbu (kick, hug), got \"hugg\"; did you "
                        "mean hug?"));
}

TEST_F(ProgramTest, ServerIsReadFromTheEnvironment) {
  variables_["DUET_SERVER"] = "lab:7";
  EXPECT_CALL(*connection_, ListModels).WillRepeatedly(Return(std::vector{SbuModel().model}));
  EXPECT_EQ(Run({"models"}), 0);
  EXPECT_EQ(options_.server_address, "lab:7");
  EXPECT_EQ(Run({"models", "--server", "mine:8"}), 0);
  EXPECT_EQ(options_.server_address, "mine:8");
}

TEST_F(ProgramTest, UsageErrorMakesNoCall) {
  EXPECT_CALL(*connection_, GetModel).Times(0);
  EXPECT_EQ(Synthesize("pair.fbx"), 2);
  EXPECT_THAT(err_.str(), HasSubstr(".fbx"));
  EXPECT_EQ(out_.str(), "");
}

TEST_F(ProgramTest, MissingLeaderMakesNoCall) {
  EXPECT_CALL(*connection_, GetModel).Times(0);
  EXPECT_EQ(Run({"synthesize", "--leader", Path("no.bvh"), "--label", "kick=1", "--out",
                 Path("pair.html")}),
            42);
  EXPECT_THAT(err_.str(), HasSubstr("no.bvh: no such file"));
}

TEST_F(ProgramTest, MissingFollowerStartMakesNoCall) {
  EXPECT_CALL(*connection_, GetModel).Times(0);
  EXPECT_EQ(Synthesize("pair.html", {"--follower-start", Path("no.bvh")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("no.bvh: no such file"));
  EXPECT_EQ(Synthesize("pair.html", {"--follower-start", "0,1"}), 42);
  EXPECT_THAT(err_.str(),
              HasSubstr("--follower-start: 0,1: no such file; expected a motion file or "
                        "X,Y,Z"));
}

TEST_F(ProgramTest, AMalformedLeaderIsBadInput) {
  WriteTestFile(folder_ / "leader.csv", "not,a,motion\n1,2,3\n");
  EXPECT_CALL(*connection_, Synthesize).Times(0);
  EXPECT_EQ(Synthesize("pair.html"), 42);
  EXPECT_THAT(err_.str(), HasSubstr("leader.csv"));
  EXPECT_FALSE(Exists("pair.html"));
}

TEST_F(ProgramTest, JointMapFileMapsTheJoints) {
  std::string text = ReadTestFile(folder_ / "leader.csv");
  text = absl::StrReplaceAll(text, {{".left_hand_", ".paw_"}, {".right_hand_", ".claw_"}});
  WriteTestFile(folder_ / "leader.csv", text);
  EXPECT_EQ(Synthesize("pair.html"), 42);
  EXPECT_THAT(err_.str(),
              AllOf(HasSubstr("joints: expected joints for left_hand, right_hand, got none"),
                    HasSubstr("Specify it with --joint-map MODEL_JOINT=FILE_JOINT, or a "
                              "table of them with --joint-map-file FILE.\n")));
  SynthesisRequest sent;
  EXPECT_CALL(*connection_, Synthesize)
      .WillRepeatedly([&](const SynthesisRequest& request, const ChunkCallback&) {
        sent = request;
        return Follow(request);
      });
  WriteTestFile(folder_ / "rig.txt", "# ours\nleft_hand = paw\nright_hand = paw\n");
  ASSERT_EQ(Synthesize("pair.html",
                       {"--joint-map-file", Path("rig.txt"), "--joint-map", "right_hand=claw"}),
            0)
      << err_.str();
  const int left = motion::SbuSkeleton().Find("left_hand");
  const int right = motion::SbuSkeleton().Find("right_hand");
  EXPECT_NEAR(sent.leader.at(3, left).x, leader_.at(3, left).x, 1e-5);
  EXPECT_NEAR(sent.leader.at(3, right).x, leader_.at(3, right).x, 1e-5);
  WriteTestFile(folder_ / "rig.txt", "left_hand\n");
  EXPECT_EQ(Synthesize("pair.html", {"--joint-map-file", Path("rig.txt")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("rig.txt:1: expected MODEL_JOINT=FILE_JOINT"));
}

TEST_F(ProgramTest, MissingJointMapFileMakesNoCall) {
  EXPECT_CALL(*connection_, GetModel).Times(0);
  EXPECT_EQ(Synthesize("pair.html", {"--joint-map-file", Path("no.txt")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("no.txt: no such file"));
}

TEST_F(ProgramTest, AMissingFrameRateNamesItsFlag) {
  std::string text = ReadTestFile(folder_ / "leader.csv");
  WriteTestFile(folder_ / "leader.csv", text.substr(text.find('\n') + 1));
  EXPECT_EQ(Synthesize("pair.html"), 42);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("frame rate: expected one, got none"),
                                HasSubstr("\nSpecify it with --frame-rate HZ.\n")));
}

TEST_F(ProgramTest, UnknownUnitNamesItsFlag) {
  motion::Clip point = leader_;
  for (motion::Vec3& position : point.poses.all()) position = {0, 1, 0};
  ASSERT_THAT(formats::WritePair(folder_ / "pair.bvh", {point, point}, motion::SbuSkeleton()),
              IsOk());
  EXPECT_EQ(Run({"synthesize", "--leader", Path("pair.leader.bvh"), "--label", "kick=1", "--out",
                 Path("pair.html")}),
            42);
  EXPECT_THAT(err_.str(), HasSubstr("\nSpecify it with --metres-per-unit METRES.\n"));
}

TEST_F(ProgramTest, RejectionListsEveryField) {
  absl::Status refusal = ServiceError(absl::StatusCode::kInvalidArgument, "refused");
  refusal.SetPayload("type.googleapis.com/google.rpc.BadRequest", absl::Cord("\x0a\x07\x0a\x01"
                                                                             "a\x12\x02"
                                                                             "b1\x0a\x07\x0a\x01"
                                                                             "c\x12\x02"
                                                                             "d2"));
  EXPECT_CALL(*connection_, Synthesize).WillOnce(Return(refusal));
  EXPECT_EQ(Synthesize("pair.html"), 42);
  EXPECT_EQ(err_.str(),
            "duet: the server rejects the request (INVALID_ARGUMENT)\n  a: b1\n  c: d2\n");
}

TEST_F(ProgramTest, MissingServerIsNamedAndExitsWithRetry) {
  EXPECT_CALL(*connection_, GetModel).WillOnce(Return(absl::UnavailableError("refused")));
  EXPECT_EQ(Synthesize("pair.html", {"--server", "duet:1"}), 1);
  EXPECT_EQ(err_.str(),
            "duet: refused (UNAVAILABLE)\nStart a duet-server at duet:1, or name another one with "
            "--server HOST:PORT (and --tls or --tls-ca FILE if it encrypts).\n");
}

TEST_F(ProgramTest, DrainingServerExitsWithRetry) {
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce(Return(ServiceError(absl::StatusCode::kUnavailable, "draining")));
  EXPECT_EQ(Synthesize("pair.html"), 1);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("draining"), HasSubstr("Trying again later may help"),
                                Not(HasSubstr("--server"))));
}

TEST_F(ProgramTest, UnwritableResultExitsWithRetry) {
  // A folder in the place of the file is only there once the command line has been checked.
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce([this](const SynthesisRequest& request, const ChunkCallback&) {
        std::filesystem::remove_all(folder_ / "out");
        return Follow(request);
      });
  std::filesystem::create_directory(folder_ / "out");
  EXPECT_EQ(Synthesize("out/pair.html"), 1);
  EXPECT_THAT(err_.str(), HasSubstr("cannot write the result"));
}

TEST_F(ProgramTest, ModelWithoutASkeletonIsAnInternalError) {
  ModelDetails details = SbuModel();
  details.model.root_joint = "tail";
  EXPECT_CALL(*connection_, GetModel).WillOnce(Return(details));
  EXPECT_EQ(Synthesize("pair.html"), 1);
  EXPECT_THAT(err_.str(), HasSubstr("the server's model sbu@1 has no usable skeleton"));
}

TEST_F(ProgramTest, ModelWithoutHipsAndFeetIsAccepted) {
  ModelDetails details = SbuModel();
  details.model.joint_names = {"torso", "head"};
  details.model.bones = {{0, 1}};
  SynthesisRequest sent;
  EXPECT_CALL(*connection_, GetModel).WillOnce(Return(details));
  EXPECT_CALL(*connection_, Synthesize)
      .WillOnce([&](const SynthesisRequest& request, const ChunkCallback&) {
        sent = request;
        return Follow(request);
      });
  ASSERT_EQ(Synthesize("pair.csv", {"--out", Path("pair.html")}), 0) << err_.str();
  EXPECT_EQ(sent.leader.joint_names, details.model.joint_names);
  ASSERT_EQ(sent.leader.frame_count(), kFrames);
  const int torso = motion::SbuSkeleton().Find("torso");
  EXPECT_NEAR(sent.leader.at(5, 0).y, leader_.at(5, torso).y, 1e-5);
  EXPECT_TRUE(Exists("pair.csv"));
}

TEST_F(ProgramTest, CertificatesAreReadFromTheirFiles) {
  const test::TestCertificate authority = test::MakeTestCertificate("authority.test");
  const test::TestCertificate own = test::MakeTestCertificate("client.test");
  WriteTestFile(folder_ / "ca.pem", authority.certificate);
  WriteTestFile(folder_ / "cert.pem", own.certificate);
  WriteTestFile(folder_ / "key.pem", own.private_key);
  EXPECT_CALL(*connection_, ListModels).WillOnce(Return(std::vector<ModelInfo>{}));
  EXPECT_EQ(Run({"models", "--tls-ca", Path("ca.pem"), "--tls-cert", Path("cert.pem"), "--tls-key",
                 Path("key.pem"), "--tls-server-name", "duet"}),
            0);
  ASSERT_TRUE(options_.tls.has_value());
  EXPECT_EQ(options_.tls->root_certificates, authority.certificate);
  EXPECT_EQ(options_.tls->certificate_chain, own.certificate);
  EXPECT_EQ(options_.tls->private_key, own.private_key);
  EXPECT_EQ(options_.tls->server_name, "duet");
  EXPECT_EQ(out_.str(), "The server serves no model.\n");
}

TEST_F(ProgramTest, TokenIsTheOnlyLineOfItsFile) {
  WriteTestFile(folder_ / "token", "secret-1\n");
  EXPECT_CALL(*connection_, ListModels).WillOnce(Return(std::vector<ModelInfo>{}));
  EXPECT_EQ(Run({"models", "--token-file", Path("token"), "--authority", "duet.example"}), 0);
  EXPECT_EQ(options_.token, "secret-1");
  EXPECT_EQ(options_.authority, "duet.example");
  EXPECT_FALSE(options_.tls.has_value());
}

TEST_F(ProgramTest, ATokenFileWithoutATokenIsBadInput) {
  WriteTestFile(folder_ / "token", " \n");
  EXPECT_EQ(Run({"models", "--token-file", Path("token")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("token: expected a token, got an empty file"));
  EXPECT_EQ(Run({"models", "--token-file", Path("no-token")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("no-token"));
}

TEST_F(ProgramTest, AMissingCertificateIsBadInput) {
  EXPECT_EQ(Run({"models", "--tls-ca", Path("no.pem")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("no.pem"));
}

TEST_F(ProgramTest, AFileWithoutACertificateIsBadInput) {
  const test::TestCertificate own = test::MakeTestCertificate("client.test");
  WriteTestFile(folder_ / "junk.pem", "certificate");
  WriteTestFile(folder_ / "empty.pem", "");
  WriteTestFile(folder_ / "cert.pem", own.certificate);
  WriteTestFile(folder_ / "other.pem", test::MakeTestCertificate("other.test").private_key);
  const std::string cert = Path("cert.pem"), junk = Path("junk.pem"), other = Path("other.pem");
  EXPECT_EQ(Run({"models", "--tls-ca", junk}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("tls_ca: " + junk + ": expected PEM certificates, got none"));
  EXPECT_EQ(Run({"models", "--tls-ca", Path("empty.pem")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("empty.pem: expected PEM, got an empty file"));
  EXPECT_EQ(Run({"models", "--tls-cert", junk, "--tls-key", other}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("tls_cert: " + junk + ": expected PEM certificates, "));
  EXPECT_EQ(Run({"models", "--tls-cert", cert, "--tls-key", junk}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("tls_key: " + junk + ": expected a private key in PEM "));
  EXPECT_EQ(Run({"models", "--tls-cert", cert, "--tls-key", other}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("tls_key: " + other +
                                    ": expected the key of the first "
                                    "certificate in tls_cert: " +
                                    cert + ", got another"));
}

TEST_F(ProgramTest, AFileTooLargeForACertificateIsBadInput) {
  WriteTestFile(folder_ / "ca.pem", std::string((1 << 20) + 1, 'x'));
  EXPECT_EQ(Run({"models", "--tls-ca", Path("ca.pem")}), 42);
  EXPECT_THAT(err_.str(), HasSubstr("ca.pem: expected a PEM file of at most 1 MiB, got more"));
}

}  // namespace
}  // namespace duet::client::cli
