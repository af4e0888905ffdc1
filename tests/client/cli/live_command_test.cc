// duet live in one process: real files and streams, a server that mirrors the leader.
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/command.h"
#include "client/mocks/mock_connection.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json.hpp"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/live_mirror.h"
#include "tests/client/support/text_input.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

using nlohmann::json;
using test::FakeServer;
using test::LiveMirror;
using test::LiveServerStream;
using test::ReadTestFile;
using test::TemporaryFolder;
using test::WriteTestFile;

constexpr int kFrames = 20;

// Describes a model itself, and leaves live sessions to a real connection.
std::shared_ptr<Connection> DescribeModel(const Client& live) {
  auto connection = std::make_shared<::testing::NiceMock<MockConnection>>();
  ModelDetails details;
  details.model.name = "dancer";
  details.model.version = 3;
  details.model.interaction_classes = {"kick", "hug"};
  details.model.joint_names = motion::SbuSkeleton().joint_names;
  details.model.bones = motion::SbuSkeleton().bones;
  details.model.root_joint = "torso";
  ON_CALL(*connection, GetModel).WillByDefault(::testing::Return(details));
  ON_CALL(*connection, StartLive)
      .WillByDefault([live](const LiveRequest& request, LiveCallbacks callbacks) {
        return live.StartLive(request, std::move(callbacks));
      });
  return connection;
}

class LiveCommandTest : public ::testing::Test {
 protected:
  LiveCommandTest() {
    server_.service().on_live = [this](grpc::ServerContext* context, LiveServerStream* stream) {
      return mirror_.Run(context, stream);
    };
    EXPECT_THAT(formats::WritePeople(folder_ / "leader.csv", formats::Format::kCsv, {leader_},
                                     motion::SbuSkeleton()),
                IsOk());
  }

  // duet live --label hug=0 ...
  int Run(const std::vector<std::string>& more) {
    out_.str("");
    err_.str("");
    std::vector<std::string> arguments = {"live", "--server", server_.address()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (!labelled_) arguments.insert(arguments.end(), {"--label", "hug=0"});
    const test::TextInput in(in_);
    const ProgramEnvironment environment{
        [](const ClientOptions& options) -> absl::StatusOr<Client> {
          absl::StatusOr<Client> live = Client::Create(options);
          if (!live.ok()) return live.status();
          return Client(DescribeModel(*live));
        },
        &out_, &err_, endless_ ? endless_->reader() : in.descriptor()};
    return RunProgram(arguments, environment);
  }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string Leader() const { return Path("leader.csv"); }

  // JSON lines of the leader's frames [0, frames).
  std::string Lines(int frames) const {
    std::string lines = json({{"joints", leader_.joint_names}, {"rate", 15}}).dump() + "\n";
    for (int frame = 0; frame < frames; ++frame) {
      json rows = json::array();
      for (const motion::Vec3& point : leader_.poses[frame]) {
        rows.push_back({point.x, point.y, point.z});
      }
      absl::StrAppend(&lines, json({{"positions", rows}}).dump(), "\n");
    }
    return lines;
  }

  motion::Clip ReadFollower(const std::string& name) const {
    absl::StatusOr<motion::Clip> clip = formats::ReadLeader(folder_ / name);
    EXPECT_THAT(clip, IsOk());
    return clip.ok() ? *std::move(clip) : motion::Clip();
  }

  TemporaryFolder folder_;
  const motion::Clip leader_ = test::SwayingClip(kFrames, 15);
  LiveMirror mirror_;  // outlives the server
  FakeServer server_;
  bool labelled_ = false;
  std::string in_;
  std::optional<test::Pipe> endless_;  // instead of in_
  std::ostringstream out_, err_;
};

TEST_F(LiveCommandTest, AFileIsAnsweredIntoFiles) {
  // The leader is never more than the delay ahead of the frame that is answered.
  std::atomic<int> most_ahead{0};
  mirror_.before_frame = [&](int, int frame) {
    if (frame >= 0 && frame < kFrames - 3) {
      most_ahead = std::max<int>(most_ahead, mirror_.messages() - frame);
    }
    return grpc::Status::OK;
  };
  ASSERT_EQ(Run({"--from", Leader(), "--to", Path("follower.csv"), "--to", Path("f.bvh"), "--to",
                 Path("pair.html"), "--seed", "7", "--delay", "2"}),
            0)
      << err_.str();
  const motion::Clip follower = ReadFollower("follower.csv");
  ASSERT_EQ(follower.frame_count(), kFrames);
  EXPECT_EQ(follower.frame_rate_hz, 15);
  EXPECT_NEAR(follower.at(19, 3).x, leader_.at(19, 3).x + 1, 1e-4);
  EXPECT_EQ(ReadFollower("f.bvh").frame_count(), kFrames);
  EXPECT_THAT(ReadTestFile(folder_ / "pair.html"), HasSubstr("leader"));
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("model     dancer@3, seed 7, delay 2 frames\n"),
                                HasSubstr("20 follower frames at 15 Hz\n"),
                                HasSubstr(absl::StrCat("wrote     ", Path("follower.csv"), "\n")),
                                Not(HasSubstr("losses")), Not(HasSubstr("resumed"))));
  EXPECT_EQ(err_.str(), "");
  const v1::LiveStart start = mirror_.starts().at(0);
  EXPECT_EQ(start.seed(), 7u);
  EXPECT_EQ(start.delay_frames(), 2u);
  EXPECT_EQ(start.leader().frame_rate_hz(), 15);
  EXPECT_LE(most_ahead, 4) << "the message that is being answered, and one that follows it";
}

TEST_F(LiveCommandTest, FlagsAndTheRequestReachTheServer) {
  labelled_ = true;
  WriteTestFile(folder_ / "request",
                "clean_up: CLEAN_UP_OFF partner_direction { z: 1 } seed: 9 "
                "model { name: 'dancer' version: 3 }");
  ASSERT_EQ(Run({"--from", Leader(), "--to", Path("follower.json"), "--request", Path("request"),
                 "--keyframe", "0:hug=1", "--keyframe", "10:hug=0,kick=1", "--variety", "0.5",
                 "--candidates", "3", "--follower-start", "0,1,2"}),
            0)
      << err_.str();
  const v1::LiveStart start = mirror_.starts().at(0);
  ASSERT_EQ(start.label_keyframes_size(), 2);
  EXPECT_EQ(start.label_keyframes(1).frame(), 10u);
  EXPECT_EQ(start.seed(), 9u);
  EXPECT_EQ(start.variety(), 0.5);
  EXPECT_EQ(start.candidates(), 3u);
  EXPECT_EQ(start.clean_up(), v1::CLEAN_UP_OFF);
  EXPECT_EQ(start.follower_start().root_position().z(), 2);
  EXPECT_EQ(start.partner_direction().z(), 1);
  EXPECT_EQ(start.model().version(), 3u);
  EXPECT_THAT(out_.str(), HasSubstr(absl::StrCat("wrote     ", Path("follower.json"), "\n")));
}

TEST_F(LiveCommandTest, FieldsOfWholeClipsAreRejected) {
  const std::pair<const char*, const char*> cases[] = {
      {"constraints { joint_name: 'head' }", "constraints: expected none"},
      {"reply_rotations: true", "reply_rotations: expected none"},
      {"chunk_frames: 3", "chunk_frames: expected none"},
      {"priority: PRIORITY_BULK", "priority: expected none"}};
  for (const auto& [text, message] : cases) {
    WriteTestFile(folder_ / "request", text);
    EXPECT_EQ(Run({"--from", Leader(), "--to", "-", "--request", Path("request")}), kExitBadInput);
    EXPECT_THAT(err_.str(), HasSubstr(message));
  }
  EXPECT_THAT(mirror_.starts(), IsEmpty());
}

TEST_F(LiveCommandTest, LinesInLinesOut) {
  in_ = Lines(kFrames);
  ASSERT_EQ(Run({"--from", "-", "--to", "-"}), 0) << err_.str();
  const std::vector<std::string> lines = absl::StrSplit(out_.str(), '\n', absl::SkipEmpty());
  ASSERT_EQ(lines.size(), kFrames + 1u);
  EXPECT_EQ(json::parse(lines[0])["rate"], 15);
  for (int frame = 0; frame < kFrames; ++frame) {
    const json line = json::parse(lines[static_cast<size_t>(frame) + 1]);
    EXPECT_EQ(line["frame"], frame);
    EXPECT_NEAR(line["positions"][2][0].get<float>(), leader_.at(frame, 2).x + 1, 1e-4);
  }
  EXPECT_THAT(err_.str(), HasSubstr("wrote     standard output: 20 frames\n"));
}

TEST_F(LiveCommandTest, AnInputThatEndsEarlyIsAnsweredSoFar) {
  in_ = Lines(7);
  ASSERT_EQ(Run({"--from", "-", "--to", Path("follower.csv")}), 0) << err_.str();
  EXPECT_EQ(ReadFollower("follower.csv").frame_count(), 7);
  in_ = Lines(0);
  ASSERT_EQ(Run({"--from", "-", "--to", Path("none.csv")}), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("none.csv: not written, no frames\n"));
}

TEST_F(LiveCommandTest, AMalformedLineIsNamedAndTheFramesBeforeItAreWritten) {
  in_ = Lines(7) + "{\"positions\": 3}\n";
  EXPECT_EQ(Run({"--from", "-", "--to", Path("follower.csv")}), kExitBadInput);
  EXPECT_THAT(err_.str(), HasSubstr("standard input: line 9: positions: expected"));
  EXPECT_EQ(ReadFollower("follower.csv").frame_count(), 7);
}

TEST_F(LiveCommandTest, AFailedSessionStopsAnInputThatGoesOn) {
  endless_.emplace();
  endless_->Write(Lines(10));
  mirror_.before_frame = [](int, int frame) {
    return frame == 5 ? grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "not finite")
                      : grpc::Status::OK;
  };
  EXPECT_EQ(Run({"--from", "-", "--to", Path("follower.csv")}), kExitBadInput);
  EXPECT_THAT(err_.str(), HasSubstr("not finite"));
  EXPECT_EQ(ReadFollower("follower.csv").frame_count(), 5);
  endless_->CloseWriter();
}

TEST_F(LiveCommandTest, InterruptionsAreReported) {
  mirror_.before_frame = [](int stream, int frame) {
    return stream == 0 && frame == 8 ? grpc::Status(grpc::StatusCode::UNAVAILABLE, "gone")
                                     : grpc::Status::OK;
  };
  ASSERT_EQ(Run({"--from", Leader(), "--to", Path("follower.csv")}), 0) << err_.str();
  EXPECT_EQ(ReadFollower("follower.csv").frame_count(), kFrames);
  EXPECT_THAT(out_.str(), HasSubstr("resumed   1 time, without losing a frame\n"));
  EXPECT_EQ(err_.str(),
            "duet: the session's stream ended after 8 frames: gone; resuming\n"
            "duet: resumed\n");
  EXPECT_EQ(Run({"--from", Leader(), "--to", Path("follower.csv"), "--quiet"}), 0);
  EXPECT_EQ(out_.str() + err_.str(), "");
}

TEST_F(LiveCommandTest, UsageErrorsAreFoundBeforeTheServerIsCalled) {
  const auto refuses = [this](std::vector<std::string> arguments, const std::string& error) {
    EXPECT_EQ(Run(arguments), kExitUsage);
    EXPECT_THAT(err_.str(), HasSubstr(error));
  };
  refuses({"--to", "-"}, "--from is required");
  refuses({"--from", "-"}, "--to is required");
  refuses({"--from", "-", "--to", "-", "--to", "-"}, "--to: expected - once, got it twice");
  refuses({"--from", "-", "--to", Path("a.mov")}, "extension");
  refuses({"--from", "-", "--to", Path("a.txt")}, "expected a format that can hold one person");
  refuses({"--from", Leader(), "--to", Leader()}, "would replace the file that is read");
  refuses({"--from", "-", "--to", Leader(), "--follower-start", Leader()}, "would replace");
  std::filesystem::create_directory(Path("folder.csv"));
  refuses({"--from", "-", "--to", Path("folder.csv")}, "expected a file, got a folder");
  refuses({"--from", "-", "--to", "-", "--delay", "11"}, "--delay");
  labelled_ = true;
  refuses({"--from", "-", "--to", "-"}, "--label, --keyframe or --request is required");
  EXPECT_THAT(mirror_.starts(), IsEmpty());
}

// A session may last for an hour, and cannot be repeated.
TEST_F(LiveCommandTest, AFileThatCannotBeCreatedIsReportedBeforeTheSession) {
  EXPECT_EQ(Run({"--from", Leader(), "--to", "/proc/follower.csv"}), kExitRetry);
  EXPECT_THAT(err_.str(), HasSubstr("/proc/follower.csv: cannot be written: "));
  EXPECT_THAT(mirror_.starts(), IsEmpty());
  ASSERT_EQ(Run({"--from", Leader(), "--to", Path("follower.csv")}), 0) << err_.str();
  EXPECT_FALSE(std::filesystem::exists(Path("follower.csv.partial")));
}

}  // namespace
}  // namespace duet::client::cli
