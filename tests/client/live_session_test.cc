// Live sessions over real connections to in-process servers.
#include "client/live_session.h"

#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/notification.h"
#include "absl/time/clock.h"
#include "client/client.h"
#include "client/internal/connect.h"
#include "client/internal/live_session_impl.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/live_mirror.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"

namespace duet::client {
namespace {

using test::FakeServer;
using test::kLongestCall;
using test::LiveMirror;
using test::LiveServerStream;
using test::ThreeJointLeader;

using Kind = LiveNotice::Kind;

grpc::Status Away() { return {grpc::StatusCode::UNAVAILABLE, "going away"}; }

class LiveSessionTest : public ::testing::Test {
 protected:
  LiveSessionTest() {
    Serve(&server_, &mirror_);
    request_.joint_names = leader_.joint_names;
    request_.frame_rate_hz = leader_.frame_rate_hz;
    request_.weights = {{"hug", 0}};
    options_.server_address = server_.address();
    options_.deadline = kLongestCall;
    // Retries without noticeable waits.
    options_.retry.initial_backoff = absl::Milliseconds(1);
    options_.retry.max_backoff = absl::Milliseconds(2);
  }

  static void Serve(FakeServer* server, LiveMirror* mirror) {
    server->service().on_live = [mirror](grpc::ServerContext* context, LiveServerStream* stream) {
      return mirror->Run(context, stream);
    };
  }

  LiveCallbacks Callbacks() {
    LiveCallbacks callbacks;
    callbacks.on_frames = [this](const LiveFrames& frames) {
      const std::lock_guard<std::mutex> lock(mutex_);
      EXPECT_EQ(frames.first_frame, follower_.frame_count());
      follower_.Append(frames.poses.all());
      if (frames.rotations.has_value()) {
        EXPECT_THAT(frames.rotations->rig, SizeIs(1));
        rotations_.insert(rotations_.end(), frames.rotations->rotations.begin(),
                          frames.rotations->rotations.end());
      }
      last_ = frames;
      return absl::OkStatus();
    };
    callbacks.on_notice = [this](const LiveNotice& notice) {
      const std::lock_guard<std::mutex> lock(mutex_);
      notices_.push_back(notice);
    };
    return callbacks;
  }

  absl::Status Start() {
    absl::StatusOr<Client> client = Client::Create(options_);
    if (!client.ok()) return client.status();
    absl::StatusOr<std::unique_ptr<LiveSession>> session = client->StartLive(request_, Callbacks());
    if (!session.ok()) return session.status();
    session_ = *std::move(session);
    return absl::OkStatus();
  }

  absl::Status Send(int first, int end) {
    for (int frame = first; frame < end; ++frame) {
      absl::Status status = session_->Send(frame, leader_.poses[frame], frame / 30.0);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::StatusOr<LiveSummary> StartSendFinish() {
    absl::Status status = Start();
    if (status.ok()) status = Send(0, leader_.frame_count());
    if (!status.ok()) return status;
    return session_->Finish();
  }

  // What the mirror answers if nothing goes wrong and `hug` is 0.
  motion::Poses Expected() const {
    motion::Poses follower = leader_.poses;
    for (motion::Vec3& position : follower.all()) position.x += 1;
    return follower;
  }

  std::vector<Kind> Kinds() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Kind> kinds;
    for (const LiveNotice& notice : notices_) kinds.push_back(notice.kind);
    return kinds;
  }

  // The rotations of all frames: of one joint.
  std::vector<motion::UnitQuaternion> rotations_;
  motion::Clip leader_ = ThreeJointLeader(40);
  absl::Notification finished_;  // outlives the server, as does the mirror
  LiveMirror mirror_;
  FakeServer server_;
  ClientOptions options_;
  LiveRequest request_;
  std::mutex mutex_;
  motion::Poses follower_{0, 3};
  LiveFrames last_;
  std::vector<LiveNotice> notices_;
  std::unique_ptr<LiveSession> session_;
};

TEST_F(LiveSessionTest, RotationsKeepTheirSignsOverAnInterruption) {
  request_.rotations = true;
  mirror_.before_frame = [](int stream, int frame) {
    return stream == 0 && frame == 17 ? Away() : grpc::Status::OK;
  };
  ASSERT_THAT(StartSendFinish(), IsOk());
  ASSERT_THAT(rotations_, SizeIs(40));
  for (int frame = 0; frame < 40; ++frame) {
    const float half = 0.25F * static_cast<float>(frame);
    EXPECT_NEAR(rotations_[static_cast<size_t>(frame)].w, std::cos(half), 1e-6) << frame;
    EXPECT_NEAR(rotations_[static_cast<size_t>(frame)].x, std::sin(half), 1e-6) << frame;
  }
  const std::vector<v1::LiveStart> starts = mirror_.starts();
  ASSERT_THAT(starts, SizeIs(2));
  const v1::LiveHistory& history = starts[1].history();
  EXPECT_GT(history.first_frame(), 0);
  ASSERT_EQ(history.rig_leader_positions_size(), 9);
  ASSERT_EQ(history.rig_follower_positions_size(), 9);
  EXPECT_EQ(history.rig_leader_positions(3), leader_.poses[0][1].x);
  EXPECT_EQ(history.rig_follower_positions(3), follower_[0][1].x);
}

TEST_F(LiveSessionTest, AnswersEveryFrameInOrder) {
  request_.seed = 7;
  const absl::StatusOr<LiveSummary> summary = StartSendFinish();
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_EQ(summary->leader_frames, 40);
  EXPECT_EQ(summary->follower_frames, 40);
  EXPECT_EQ(summary->resumed, 0);
  EXPECT_EQ(session_->info().model_name, "dancer");
  EXPECT_EQ(session_->info().model_version, 3);
  EXPECT_EQ(session_->info().seed, 7u);
  EXPECT_TRUE(session_->info().cleaned_up);
  EXPECT_EQ(last_.leader_frame, 39);
  EXPECT_DOUBLE_EQ(last_.capture_seconds, 39 / 30.0);
  EXPECT_THAT(notices_, SizeIs(0));
}

TEST_F(LiveSessionTest, ABrokenStreamIsResumedWithTheHistory) {
  mirror_.before_frame = [](int stream, int frame) {
    return stream == 0 && frame == 12 ? Away() : grpc::Status::OK;
  };
  const absl::StatusOr<LiveSummary> summary = StartSendFinish();
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_EQ(summary->resumed, 1);
  EXPECT_THAT(Kinds(), ElementsAre(Kind::kInterrupted, Kind::kResumed));
  EXPECT_THAT(notices_[0].message, HasSubstr("after 12 frames: going away"));
  ASSERT_THAT(mirror_.starts(), SizeIs(2));
  const v1::LiveStart start = mirror_.starts()[1];
  EXPECT_EQ(start.history().first_frame(), 7u);  // five frames before the twelfth
  EXPECT_EQ(start.history().follower_frame_count(), 5u);
  EXPECT_GE(start.leader().frame_count(), 5u);  // and those that have no answer
  EXPECT_EQ(start.leader().positions(0), leader_.at(7, 0).x);
  EXPECT_EQ(start.model().name(), "dancer");
  EXPECT_EQ(start.model().version(), 3u);
  EXPECT_EQ(start.clean_up(), v1::CLEAN_UP_ON);
  EXPECT_FALSE(mirror_.starts()[0].has_seed());
  EXPECT_TRUE(start.has_seed()) << "the one that the server chose";
}

TEST_F(LiveSessionTest, AStartHasAtMostTenSecondsOfTheLeader) {
  leader_ = ThreeJointLeader(500);
  mirror_.before_frame = [this](int stream, int frame) {
    if (stream > 0 || frame < 12) return grpc::Status::OK;
    finished_.WaitForNotificationWithTimeout(kLongestCall);
    return Away();
  };
  ASSERT_THAT(Start(), IsOk());
  ASSERT_THAT(Send(0, 500), IsOk());
  finished_.Notify();
  ASSERT_THAT(session_->Finish(), IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_EQ(mirror_.starts()[1].leader().frame_count(), 300u);
}

TEST_F(LiveSessionTest, ASessionWithoutAnAnswerBeginsAnew) {
  request_.follower_start = motion::Vec3{0, 1, 2};
  mirror_.before_frame = [](int stream, int frame) {
    return stream == 0 && frame == 0 ? Away() : grpc::Status::OK;
  };
  ASSERT_THAT(StartSendFinish(), IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_FALSE(mirror_.starts()[1].has_history());
  EXPECT_TRUE(mirror_.starts()[1].has_follower_start());
}

TEST_F(LiveSessionTest, TheDelayHoldsAcrossStreams) {
  request_.delay_frames = 3;
  request_.follower_start = motion::Vec3{0, 1, 2};
  mirror_.before_frame = [](int stream, int frame) {
    return stream < 3 && frame == 10 * (stream + 1) ? Away() : grpc::Status::OK;
  };
  const absl::StatusOr<LiveSummary> summary = StartSendFinish();
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_EQ(summary->resumed, 3);
  ASSERT_THAT(mirror_.starts(), SizeIs(4));
  const v1::LiveStart start = mirror_.starts()[2];
  EXPECT_EQ(start.history().first_frame(), 15u);
  EXPECT_EQ(start.history().follower_frame_count(), 5u);
  EXPECT_GE(start.leader().frame_count(), 8u);  // and the delay
  EXPECT_FALSE(start.has_follower_start());     // rejected together with history
}

TEST_F(LiveSessionTest, ADrainingServerIsLeftForAnother) {
  LiveMirror others_mirror;
  FakeServer other;
  Serve(&other, &others_mirror);
  // Whichever server has the first stream drains.
  std::atomic<int> drained{0};
  const auto drains = [&drained](int stream, int frame) {
    return stream == 0 && frame == 5 && drained++ == 0;
  };
  mirror_.drains = others_mirror.drains = drains;
  options_.server_address = absl::StrCat("ipv4:", server_.address(), ",", other.address());
  const absl::StatusOr<LiveSummary> summary = StartSendFinish();
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_THAT(Kinds(), ElementsAre(Kind::kDraining, Kind::kResumed));
}

TEST_F(LiveSessionTest, GivesUpWhenNoServerAnswers) {
  options_.wait = absl::Milliseconds(200);
  // Connected before: a busy machine may take longer than the wait.
  const auto channel = internal::OpenChannel(options_);
  ASSERT_THAT(channel, IsOk());
  ASSERT_TRUE((*channel)->WaitForConnected(absl::ToChronoTime(absl::Now() + kLongestCall)));
  absl::Notification ended;
  LiveCallbacks callbacks = Callbacks();
  callbacks.on_end = [&ended](const absl::Status& status) {
    EXPECT_FALSE(status.ok());
    ended.Notify();
  };
  absl::StatusOr<std::unique_ptr<LiveSession>> session = internal::LiveSessionImpl::Start(
      v1::MotionSynthesis::NewStub(*channel), request_, std::move(callbacks),
      {options_, internal::SystemEnvironment()});
  ASSERT_THAT(session, IsOk());
  session_ = *std::move(session);
  ASSERT_THAT(Send(0, 10), IsOk());
  server_.Kill();
  ASSERT_TRUE(ended.WaitForNotificationWithTimeout(kLongestCall));
  EXPECT_THAT(session_->Finish(), StatusIs(absl::StatusCode::kUnavailable,
                                           HasSubstr("is not running: it refused the connection")));
  EXPECT_THAT(Send(10, 11), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("")));
}

TEST_F(LiveSessionTest, LabelChangesHoldAcrossStreams) {
  mirror_.before_frame = [](int stream, int frame) {
    return stream == 0 && frame == 25 ? Away() : grpc::Status::OK;
  };
  ASSERT_THAT(Start(), IsOk());
  ASSERT_THAT(Send(0, 10), IsOk());
  ASSERT_THAT(session_->ChangeLabels({{"hug", 2}}, absl::ZeroDuration()), IsOk());
  ASSERT_THAT(Send(10, 20), IsOk());
  ASSERT_THAT(session_->ChangeLabels({{"hug", 1}}, absl::Seconds(8 / 30.0)), IsOk());
  ASSERT_THAT(Send(20, 40), IsOk());
  ASSERT_THAT(session_->Finish(), IsOk());
  const auto hug = [this](int frame) { return follower_.at(frame, 1).y - leader_.at(frame, 1).y; };
  EXPECT_EQ(hug(9), 0);
  EXPECT_EQ(hug(10), 2);
  EXPECT_EQ(hug(20), 2);
  EXPECT_EQ(hug(24), 1.5);
  EXPECT_EQ(hug(26), 1.25);  // of the second stream
  EXPECT_EQ(hug(28), 1);
  EXPECT_EQ(hug(39), 1);
}

TEST_F(LiveSessionTest, GapsAreFilledAlikeOnAllStreams) {
  mirror_.before_frame = [](int stream, int frame) {
    return stream == 0 && frame == 13 ? Away() : grpc::Status::OK;
  };
  ASSERT_THAT(Start(), IsOk());
  ASSERT_THAT(Send(0, 10), IsOk());
  ASSERT_THAT(Send(13, 15), IsOk());
  ASSERT_THAT(Send(12, 14), IsOk());  // too late
  ASSERT_THAT(Send(15, 40), IsOk());
  const absl::StatusOr<LiveSummary> summary = session_->Finish();
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(follower_, Expected());  // which moves evenly
  EXPECT_EQ(summary->gap_frames, 3);
}

TEST_F(LiveSessionTest, ASilentServerIsLeft) {
  mirror_.before_frame = [this](int stream, int frame) {
    if (stream == 0 && frame == 5) finished_.WaitForNotificationWithTimeout(kLongestCall);
    return grpc::Status::OK;
  };
  const auto channel = internal::OpenChannel(options_);
  ASSERT_THAT(channel, IsOk());
  absl::StatusOr<std::unique_ptr<LiveSession>> session = internal::LiveSessionImpl::Start(
      v1::MotionSynthesis::NewStub(*channel), request_, Callbacks(),
      {options_, internal::SystemEnvironment(), absl::Seconds(1)});
  ASSERT_THAT(session, IsOk());
  session_ = *std::move(session);
  ASSERT_THAT(Send(0, 40), IsOk());
  EXPECT_THAT(session_->Finish(), IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_THAT(notices_[0].message, HasSubstr("no answer for 1s"));
  finished_.Notify();
}

TEST_F(LiveSessionTest, AModelThatIsGoneEndsTheSession) {
  mirror_.before_frame = [](int stream, int frame) {
    if (stream > 0) return grpc::Status(grpc::StatusCode::NOT_FOUND, "no dancer@3");
    return frame == 6 ? Away() : grpc::Status::OK;
  };
  EXPECT_THAT(StartSendFinish(),
              StatusIs(absl::StatusCode::kAborted,
                       HasSubstr("broke after 6 frames and cannot be resumed: dancer@3")));
}

TEST_F(LiveSessionTest, AMalformedAnswerEndsTheSession) {
  server_.service().on_live = [this](grpc::ServerContext*, LiveServerStream* stream) {
    v1::SynthesizeLiveRequest request;
    stream->Read(&request);
    v1::SynthesizeLiveResponse response;
    v1::LiveHeader* header = response.mutable_header();
    *header->mutable_joint_names() = request.start().leader().joint_names();
    header->set_frame_rate_hz(leader_.frame_rate_hz);
    header->set_unit(v1::LENGTH_UNIT_METRES);
    header->set_up_axis(v1::UP_AXIS_Y_UP);
    stream->Write(response);
    stream->Read(&request);
    v1::FollowerFrames* frames = response.mutable_frames();
    frames->set_first_frame(1);
    stream->Write(response);
    while (stream->Read(&request)) {
    }
    return grpc::Status::OK;
  };
  ASSERT_THAT(Start(), IsOk());
  ASSERT_THAT(Send(0, 1), IsOk());
  EXPECT_THAT(session_->Finish(),
              StatusIs(absl::StatusCode::kInternal,
                       HasSubstr("malformed: frames.first_frame: expected 0, got 1")));
}

TEST_F(LiveSessionTest, TheCallbackEndsTheSessionWithItsOwnStatus) {
  absl::StatusOr<Client> client = Client::Create(options_);
  ASSERT_THAT(client, IsOk());
  auto session = client->StartLive(
      request_, {[](const LiveFrames&) { return absl::UnavailableError("enough"); }, {}, {}});
  ASSERT_THAT(session, IsOk());
  session_ = *std::move(session);
  ASSERT_THAT(Send(0, 1), IsOk());
  EXPECT_THAT(session_->Finish(), StatusIs(absl::StatusCode::kUnavailable, "enough"));
  EXPECT_THAT(mirror_.starts(), SizeIs(1));
}

TEST_F(LiveSessionTest, InvalidCallsAreRejectedAndTheSessionGoesOn) {
  ASSERT_THAT(Start(), IsOk());
  EXPECT_THAT(session_->Send(3, leader_.poses[3], 0),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("frames.first_frame: expected 0, got 3")));
  ASSERT_THAT(Send(0, 10), IsOk());
  EXPECT_THAT(
      session_->Send(-1, leader_.poses[0], 0),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected 0 or more, got -1")));
  EXPECT_THAT(
      session_->Send(10, leader_.poses[0].subspan(1), 0),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("multiple of 3 points, got 2")));
  EXPECT_THAT(session_->Send(71, leader_.poses[0], 0),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("expected 10 or at most 2 s later, got 71")));
  EXPECT_THAT(session_->ChangeLabels({}, absl::ZeroDuration()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected a weight")));
  EXPECT_THAT(
      session_->ChangeLabels({{"hug", 1}}, absl::Seconds(11)),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected 0 to 10s, got 11s")));
  ASSERT_THAT(Send(10, 40), IsOk());
  EXPECT_THAT(session_->Finish(), IsOk());
  EXPECT_EQ(follower_, Expected());
  EXPECT_THAT(Send(40, 40), IsOk());
  EXPECT_THAT(session_->Send(40, leader_.poses[0], 0),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("Finish")));
}

TEST_F(LiveSessionTest, InvalidRequestsAreNotSent) {
  request_.joint_names.clear();
  EXPECT_THAT(Start(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("joint_names")));
  request_.joint_names = leader_.joint_names;
  request_.delay_frames = -1;
  EXPECT_THAT(Start(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("delay_frames")));
  EXPECT_THAT(Client::Create(options_)->StartLive(request_, {}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("on_frames")));
  EXPECT_THAT(mirror_.starts(), SizeIs(0));
}

TEST_F(LiveSessionTest, ABacklogIsBounded) {
  mirror_.before_frame = [this](int, int frame) {
    if (frame == 0) finished_.WaitForNotificationWithTimeout(kLongestCall);
    return grpc::Status::OK;
  };
  ASSERT_THAT(Start(), IsOk());
  absl::Status status;
  int frame = 0;
  for (; status.ok() && frame < 10000; ++frame) {
    status = session_->Send(frame, leader_.poses[0], 0);
  }
  EXPECT_EQ(frame, 120 * 30 + 1);
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("120 s of frames")));
  finished_.Notify();
  session_ = nullptr;
}

}  // namespace
}  // namespace duet::client
