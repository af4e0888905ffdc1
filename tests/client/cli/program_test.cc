// The whole program against a connection that a test scripts.
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/mocks/mock_connection.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json.hpp"
#include "tests/client/cli/program_runner.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_certificate.h"

namespace duet::client::cli {
namespace {

using test::ReadTestFile;
using test::ServiceError;
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
SynthesisResult Follow(const SynthesisRequest& request) {
  SynthesisResult result;
  result.pair.leader = request.leader;
  result.pair.follower = request.leader;
  for (motion::Vec3& position : result.pair.follower.poses.all()) position.z -= 2;
  result.model_name = "sbu";
  result.model_version = 1;
  result.window_count = 1;
  result.attempt_count = 1;
  result.request_id = "request-1";
  result.seed = request.seed.value_or(0);
  result.variety = request.variety;
  result.candidates = request.candidates;
  result.cleaned_up = request.clean_up.value_or(false);
  result.timings.first_chunk = absl::Milliseconds(12);
  result.timings.total = absl::Milliseconds(34);
  return result;
}

class ProgramTest : public ProgramRunner {
 protected:
  ProgramTest() {
    EXPECT_THAT(
        formats::WritePair(folder_ / "leader.csv", {leader_, leader_}, motion::SbuSkeleton()),
        IsOk());
    ON_CALL(*server_, GetModel).WillByDefault(Return(SbuModel()));
    Answer([](SynthesisResult*) {});
    connection_ = server_;
  }

  // The server answers with Follow after `change`, and stores what was sent.
  void Answer(std::function<void(SynthesisResult*)> change) {
    ON_CALL(*server_, Synthesize)
        .WillByDefault([this, change = std::move(change)](const SynthesisRequest& request,
                                                          const ChunkCallback&) {
          sent_.push_back(request);
          SynthesisResult result = Follow(request);
          change(&result);
          return absl::StatusOr<SynthesisResult>(result);
        });
  }

  // duet synthesize --leader leader.csv --label kick=1 ... --out <name>
  int Synthesize(const std::string& out, const Strings& more = {}) {
    return Run(Strings{"synthesize", "--leader", Path("leader.csv"), "--out", Path(out), "--label",
                       "kick=1"} +
               more);
  }
  nlohmann::json SynthesizeJson(const Strings& more = {}) {
    EXPECT_EQ(Synthesize("pair.csv", more + Strings{"--json"}), 0) << err();
    return nlohmann::json::parse(out());
  }

  const motion::Clip leader_ = test::SwayingClip(kFrames, 15);
  const std::shared_ptr<::testing::NiceMock<MockConnection>> server_ =
      std::make_shared<::testing::NiceMock<MockConnection>>();
  std::vector<SynthesisRequest> sent_;
};

TEST_F(ProgramTest, ListsModelsAsText) {
  EXPECT_CALL(*server_, ListModels).WillOnce(Return(std::vector{SbuModel().model}));
  EXPECT_EQ(Run({"models", "--server", "duet:1", "--timeout", "3", "--wait", "0.5"}), 0);
  EXPECT_EQ(out(),
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

TEST_F(ProgramTest, ListsTheTermsOfAModelAndJson) {
  ModelInfo model = SbuModel().model;
  model.samples = true;
  model.terms = "Made by the studio.";
  model.free_for_all_uses = true;
  EXPECT_CALL(*server_, ListModels).WillRepeatedly(Return(std::vector{model}));
  EXPECT_EQ(Run({"models"}), 0);
  EXPECT_THAT(out(), HasSubstr("  answers   vary with --seed and --variety\n"));
  EXPECT_THAT(out(),
              EndsWith("\n  terms     Made by the studio.\n"
                       "  free      anybody may use the model and its output for any purpose\n"));
  EXPECT_EQ(Run({"models", "--json"}), 0);
  const nlohmann::json json = nlohmann::json::parse(out())["models"][0];
  EXPECT_EQ(json["interaction_classes"], (Strings{"kick", "hug"}));
  EXPECT_EQ(json["bones"].size(), 14u);
  EXPECT_EQ(json["samples"], true);
  EXPECT_EQ(json["free_for_all_uses"], true);
}

TEST_F(ProgramTest, WritesEveryKindOfOutput) {
  EXPECT_EQ(Synthesize("pair.html", {"--out", Path("pair.bvh"), "--out", Path("pair.csv"), "--out",
                                     Path("pair.npy"), "--out", Path("pair.json")}),
            0)
      << err();
  for (const char* name :
       {"pair.html", "pair.leader.bvh", "pair.follower.bvh", "pair.csv", "pair.npy", "pair.json"}) {
    EXPECT_TRUE(Exists(name)) << name;
    EXPECT_THAT(out(), HasSubstr(Path(name)));
  }
  EXPECT_THAT(ReadTestFile(folder_ / "pair.html"),
              AllOf(StartsWith("<!doctype html>"), HasSubstr("\"kick\"")));
}

TEST_F(ProgramTest, WritesTheFollowersRotationsToJson) {
  Answer([](SynthesisResult* result) {
    result->rotations.emplace();
    result->rotations->rig = {{"torso", -1, {}, 2}};
    result->rotations->rotations.assign(kFrames, {0, 1, 0, 0});
  });
  WriteTestFile(folder_ / "request", "reply_rotations: true");
  ASSERT_EQ(Synthesize("pair.json", {"--request", Path("request")}), 0) << err();
  EXPECT_TRUE(sent_.back().rotations);
  const auto document = nlohmann::json::parse(ReadTestFile(folder_ / "pair.json"));
  EXPECT_EQ(document["rig"][0]["name"], "torso");
  ASSERT_EQ(document["rotations"].size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(document["rotations"][3], nlohmann::json::parse("[[0.0, 1.0, 0.0, 0.0]]"));
  EXPECT_EQ(Synthesize("pair.glb", {"--request", Path("request")}), 42);
  EXPECT_THAT(err(), HasSubstr("reply_rotations: expected --out FILE.json, which holds them, got"));
}

TEST_F(ProgramTest, SendsTheFlagsAndTheRequestOfAFile) {
  WriteTestFile(folder_ / "request",
                "priority: PRIORITY_BULK chunk_frames: 8 clean_up: CLEAN_UP_ON seed: 1 "
                "partner_direction { x: 1 z: -1 }");
  EXPECT_CALL(*server_, GetModel(Field(&ModelChoice::name, "sbu")));
  ASSERT_EQ(
      Synthesize("pair.html", {"--label", "hug=-0.5", "--model", "sbu:stable", "--request",
                               Path("request"), "--follower-start", "1,1.1,-2", "--frame-rate",
                               "30", "--seed", "7", "--variety", "0.25", "--candidates", "4"}),
      0)
      << err();
  const SynthesisRequest& sent = sent_.back();
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
  EXPECT_EQ(sent.leader.frame_rate_hz, 30);
  ASSERT_EQ(sent.leader.frame_count(), kFrames);
  EXPECT_NEAR(sent.leader.at(5, 2).y, leader_.at(5, 2).y, 1e-5);
}

TEST_F(ProgramTest, PrintsASummaryAsTextOrJson) {
  ASSERT_EQ(Synthesize("pair.html", {"--label", "hug=0.5"}), 0);
  EXPECT_THAT(out(),
              HasSubstr("leader    " + Path("leader.csv") + ": 20 frames, 1.33 s at 15 Hz\n"));
  EXPECT_THAT(out(), HasSubstr("reaction  kick 1, hug 0.5\n"));
  EXPECT_THAT(out(), HasSubstr("follower  from sbu@1 in 34 ms, first frames after 12 ms"));
  EXPECT_THAT(out(), HasSubstr("wrote     " + Path("pair.html") + "\n"));
  EXPECT_THAT(out(), Not(HasSubstr("cleaned up")));
  Answer([](SynthesisResult* result) { result->cleaned_up = true; });
  ASSERT_EQ(Synthesize("pair.html"), 0);
  EXPECT_THAT(out(), HasSubstr("          cleaned up\n"));
  ASSERT_EQ(Synthesize("pair.html", {"--quiet"}), 0);
  EXPECT_EQ(out() + err(), "");
  const nlohmann::json json = SynthesizeJson();
  EXPECT_EQ(json["frames"], kFrames);
  EXPECT_EQ(json["model"]["name"], "sbu");
  EXPECT_EQ(json["weights"]["kick"], 1);
  EXPECT_EQ(json["cleaned_up"], true);
  EXPECT_FALSE(json.contains("constraints"));
  EXPECT_EQ(json["seconds"]["total"], 0.034);
  EXPECT_EQ(json["files"], Strings{Path("pair.csv")});
}

TEST_F(ProgramTest, WhatRemainsOfPinsIsReported) {
  Answer([](SynthesisResult* result) { result->constraint_metres = {0.004f, 0.123f}; });
  WriteTestFile(
      folder_ / "pins",
      "constraints { joint_name: 'head' frame: 3 position { y: 1.5 z: -2 } }"
      "constraints { joint_name: 'right_hand' frame: 7 position { x: 1 } softness: 0.5 }");
  const Strings pins = {"--request", Path("pins")};
  ASSERT_EQ(Synthesize("pair.html", pins), 0) << err();
  EXPECT_THAT(out(), HasSubstr("          pins: at most 12.3 cm away\n"));
  const nlohmann::json second = SynthesizeJson(pins)["constraints"][1];
  EXPECT_EQ(second["joint_name"], "right_hand");
  EXPECT_EQ(second["frame"], 7);
  EXPECT_EQ(second["softness"], 0.5);
  EXPECT_NEAR(second["remaining_metres"].get<double>(), 0.123, 1e-6);
}

TEST_F(ProgramTest, NoFileOfAPairReplacesAnInput) {
  EXPECT_CALL(*server_, GetModel).Times(0);
  const std::string start = Path("start.json"), leader = Path("leader.csv");
  for (const char* name : {"pair.leader.bvh", "pair.follower.bvh", "start.json", "request"}) {
    WriteTestFile(folder_ / name, "");
  }
  const struct {
    Strings flags;
    std::string replaced;
  } cases[] = {
      {{"--leader", leader, "--out", leader}, leader},
      {{"--leader", Path("pair.leader.bvh"), "--out", Path("pair.bvh")}, Path("pair.leader.bvh")},
      {{"--leader", Path("pair.follower.bvh"), "--out", Path("pair.bvh")},
       Path("pair.follower.bvh")},
      {{"--leader", leader, "--follower-start", start, "--out", start}, start}};
  for (const auto& [flags, replaced] : cases) {
    EXPECT_EQ(Run(Strings{"synthesize", "--label", "kick=1"} + flags), 2);
    EXPECT_THAT(err(), HasSubstr(replaced + ": would replace the file that is read"));
  }
}

TEST_F(ProgramTest, PrintsUnfamiliarityIfTheServerReportsIt) {
  EXPECT_FALSE(SynthesizeJson().contains("unfamiliarity"));
  double unfamiliarity = 1.25;
  Answer([&](SynthesisResult* result) { result->unfamiliarity = unfamiliarity; });
  EXPECT_EQ(SynthesizeJson()["unfamiliarity"], 1.25);
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out(), HasSubstr("          unfamiliarity 1.25 (1: as the farthest tenth"));
  EXPECT_THAT(out(), Not(HasSubstr("differs from")));
  unfamiliarity = 1.75;
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out(), HasSubstr("differs from those that the model was trained on"));
}

TEST_F(ProgramTest, PrintsTheGradeIfTheServerReportsIt) {
  EXPECT_FALSE(SynthesizeJson().contains("grade"));
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out(), Not(HasSubstr("graded")));
  MotionGrade grade{0, 0.21f, 0.45f, 0.002f, {}};
  Answer([&](SynthesisResult* result) { result->grade = grade; });
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out(), HasSubstr("          graded: twisted 0 %, both feet move 21 % (leader 45 %), "
                               "overlapping < 1 %\n"));
  EXPECT_THAT(out(), Not(HasSubstr("in frames")));
  grade.overlapping = 0.35f;
  grade.bad_runs = {{0, 1}, {3, 2}, {6, 1}, {8, 1}, {10, 1}, {12, 1}};
  ASSERT_EQ(Synthesize("pair.csv"), 0);
  EXPECT_THAT(out(),
              HasSubstr("          twisted or overlapping in frames 0, 3-4, 6, 8, 10, ...\n"));
  const nlohmann::json json = SynthesizeJson()["grade"];
  EXPECT_EQ(json["leader_skating"], 0.45);
  EXPECT_EQ(json["bad_runs"][1], (nlohmann::json{{"first_frame", 3}, {"frame_count", 2}}));
}

TEST_F(ProgramTest, ConnectionIsReadFromTheEnvironmentUnlessFlagsStateIt) {
  WriteTestFile(folder_ / "token", "secret\n");
  const std::map<const char*, std::string> variables = {
      {"DUET_SERVER", "lab:7"}, {"DUET_TIMEOUT", "3"}, {"DUET_TOKEN_FILE", Path("token")}};
  for (const auto& [name, value] : variables) setenv(name, value.c_str(), 1);
  EXPECT_CALL(*server_, ListModels).WillRepeatedly(Return(std::vector{SbuModel().model}));
  EXPECT_EQ(Run({"models"}), 0);
  EXPECT_EQ(options_.server_address, "lab:7");
  EXPECT_EQ(options_.deadline, absl::Seconds(3));
  EXPECT_EQ(options_.token, "secret");
  EXPECT_EQ(Run({"models", "--server", "mine:8"}), 0);
  EXPECT_EQ(options_.server_address, "mine:8");
  setenv("DUET_TIMEOUT", "soon", 1);
  EXPECT_EQ(Run({"models"}), 2);
  EXPECT_THAT(err(), HasSubstr("--timeout: expected "));
  EXPECT_EQ(Run({"--version"}), 0);
  for (const auto& [name, value] : variables) unsetenv(name);
}

TEST_F(ProgramTest, JointMapFileMapsTheJoints) {
  std::string text = ReadTestFile(folder_ / "leader.csv");
  text = absl::StrReplaceAll(text, {{".left_hand_", ".paw_"}, {".right_hand_", ".claw_"}});
  WriteTestFile(folder_ / "leader.csv", text);
  EXPECT_EQ(Synthesize("pair.html"), 42);
  EXPECT_THAT(err(), AllOf(HasSubstr("joints: expected joints for left_hand, right_hand, got none"),
                           HasSubstr("Specify it with --joint-map MODEL_JOINT=FILE_JOINT, or a "
                                     "table of them with --joint-map FILE.\n")));
  WriteTestFile(folder_ / "rig.txt", "# ours\nleft_hand = paw\nright_hand = paw\n");
  ASSERT_EQ(
      Synthesize("pair.html", {"--joint-map", Path("rig.txt"), "--joint-map", "right_hand=claw"}),
      0)
      << err();
  const int left = motion::SbuSkeleton().Find("left_hand");
  const int right = motion::SbuSkeleton().Find("right_hand");
  const SynthesisRequest& sent = sent_.back();
  EXPECT_NEAR(sent.leader.at(3, left).x, leader_.at(3, left).x, 1e-5);
  EXPECT_NEAR(sent.leader.at(3, right).x, leader_.at(3, right).x, 1e-5);
  WriteTestFile(folder_ / "rig.txt", "left_hand\n");
  EXPECT_EQ(Synthesize("pair.html", {"--joint-map", Path("rig.txt")}), 42);
  EXPECT_THAT(err(), HasSubstr("rig.txt:1: expected MODEL_JOINT=FILE_JOINT"));
}

TEST_F(ProgramTest, AMissingFrameRateNamesItsFlag) {
  std::string text = ReadTestFile(folder_ / "leader.csv");
  WriteTestFile(folder_ / "leader.csv", text.substr(text.find('\n') + 1));
  EXPECT_EQ(Synthesize("pair.html"), 42);
  EXPECT_THAT(err(), AllOf(HasSubstr("frame rate: expected one, got none"),
                           HasSubstr("\nSpecify it with --frame-rate HZ.\n")));
}

TEST_F(ProgramTest, RejectionListsEveryField) {
  absl::Status refusal = ServiceError(absl::StatusCode::kInvalidArgument, "refused");
  refusal.SetPayload("type.googleapis.com/google.rpc.BadRequest", absl::Cord("\x0a\x07\x0a\x01"
                                                                             "a\x12\x02"
                                                                             "b1\x0a\x07\x0a\x01"
                                                                             "c\x12\x02"
                                                                             "d2"));
  EXPECT_CALL(*server_, Synthesize).WillOnce(Return(refusal));
  EXPECT_EQ(Synthesize("pair.html"), 42);
  EXPECT_EQ(err(), "duet: the server rejects the request (INVALID_ARGUMENT)\n  a: b1\n  c: d2\n");
}

TEST_F(ProgramTest, MissingServerIsNamedAndExitsWithRetry) {
  EXPECT_CALL(*server_, GetModel).WillOnce(Return(absl::UnavailableError("refused")));
  EXPECT_EQ(Synthesize("pair.html", {"--server", "duet:1"}), 1);
  EXPECT_EQ(err(),
            "duet: refused (UNAVAILABLE)\nStart a duet-server there, or name another one with "
            "--server HOST:PORT (and --tls or --tls-ca FILE if it encrypts).\n");
}

TEST_F(ProgramTest, CertificatesAreReadFromTheirFiles) {
  const test::TestCertificate authority = test::MakeTestCertificate("authority.test");
  const test::TestCertificate own = test::MakeTestCertificate("client.test");
  WriteTestFile(folder_ / "ca.pem", authority.certificate);
  WriteTestFile(folder_ / "cert.pem", own.certificate);
  WriteTestFile(folder_ / "key.pem", own.private_key);
  EXPECT_CALL(*server_, ListModels).WillOnce(Return(std::vector<ModelInfo>{}));
  EXPECT_EQ(Run({"models", "--tls-ca", Path("ca.pem"), "--tls-cert", Path("cert.pem"), "--tls-key",
                 Path("key.pem"), "--tls-server-name", "duet"}),
            0);
  ASSERT_TRUE(options_.tls.has_value());
  EXPECT_EQ(options_.tls->root_certificates, authority.certificate);
  EXPECT_EQ(options_.tls->certificate_chain, own.certificate);
  EXPECT_EQ(options_.tls->private_key, own.private_key);
  EXPECT_EQ(options_.tls->server_name, "duet");
  EXPECT_EQ(out(), "The server serves no model.\n");
}

TEST_F(ProgramTest, BadInputsAreNamedBeforeAnyCall) {
  EXPECT_CALL(*server_, GetModel).Times(0);
  WriteTestFile(folder_ / "request", "varity: 1");
  const std::pair<Strings, const char*> cases[] = {
      {{"--leader", Path("no.bvh")}, "no.bvh: no such file"},
      {{"--follower-start", Path("no.bvh")}, "no.bvh: no such file"},
      {{"--follower-start", "0,1"},
       "--follower-start: 0,1: no such file; expected a motion file or X,Y,Z"},
      {{"--joint-map", Path("no.txt")}, "no.txt: no such file"},
      {{"--request", Path("request")}, "request: line 1:7: "},
      {{"--request", Path("no")}, "no: no such file"}};
  for (const auto& [flags, message] : cases) {
    Strings arguments = {"synthesize", "--label", "kick", "--out", Path("pair.html")};
    if (flags[0] != "--leader") arguments = arguments + Strings{"--leader", Path("leader.csv")};
    EXPECT_EQ(Run(arguments + flags), 42);
    EXPECT_THAT(err(), HasSubstr(message));
  }
}

TEST_F(ProgramTest, BadCredentialsAreNamed) {
  const test::TestCertificate own = test::MakeTestCertificate("client.test");
  WriteTestFile(folder_ / "junk.pem", "certificate");
  WriteTestFile(folder_ / "empty", " \n");
  WriteTestFile(folder_ / "large.pem", std::string((1 << 20) + 1, 'x'));
  WriteTestFile(folder_ / "cert.pem", own.certificate);
  WriteTestFile(folder_ / "other.pem", test::MakeTestCertificate("other.test").private_key);
  const std::string cert = Path("cert.pem"), junk = Path("junk.pem"), other = Path("other.pem");
  const std::pair<Strings, std::string> cases[] = {
      {{"--tls-ca", Path("no.pem")}, "no.pem"},
      {{"--tls-ca", junk}, "tls_ca: " + junk + ": expected PEM certificates, got none"},
      {{"--tls-ca", Path("large.pem")},
       "large.pem: expected a PEM file of at most 1 MiB, got more"},
      {{"--tls-cert", junk, "--tls-key", other}, "tls_cert: " + junk + ": expected PEM"},
      {{"--tls-cert", cert, "--tls-key", junk}, "tls_key: " + junk + ": expected a private key"},
      {{"--tls-cert", cert, "--tls-key", other},
       "tls_key: " + other + ": expected the key of the first certificate in tls_cert: " + cert},
      {{"--token-file", Path("empty")}, "empty: expected a token, got an empty file"},
      {{"--token-file", Path("no-token")}, "no-token"}};
  for (const auto& [flags, message] : cases) {
    EXPECT_EQ(Run(Strings{"models"} + flags), 42);
    EXPECT_THAT(err(), HasSubstr(message));
  }
}

}  // namespace
}  // namespace duet::client::cli
