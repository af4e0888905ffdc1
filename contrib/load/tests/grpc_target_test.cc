#include "contrib/load/grpc_target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <string>
#include <thread>

#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "tests/client/support/context_ends.h"
#include "tests/client/support/fake_service.h"

namespace duet::contrib::load {
namespace {

using test::FakeServer;

constexpr int kFrames = 45;

void WriteReply(int frames, bool with_summary, grpc::ServerWriter<v1::SynthesizeResponse>* writer) {
  v1::SynthesizeResponse message;
  message.mutable_header()->set_frame_count(kFrames);
  writer->Write(message);
  for (int first = 0; first < frames; first += 15) {
    message.mutable_chunk()->set_first_frame(static_cast<uint32_t>(first));
    message.mutable_chunk()->set_frame_count(15);
    writer->Write(message);
  }
  message.mutable_summary();
  if (with_summary) writer->Write(message);
}

std::string RequestNamed(const std::string& model) {
  v1::SynthesizeRequest request;
  request.mutable_model()->set_name(model);
  return request.SerializeAsString();
}

class GrpcTargetTest : public ::testing::Test {
 protected:
  std::unique_ptr<Target> Connect(int connections = 1) {
    options_.server_address = server_.address();
    options_.deadline = test::kLongestCall;
    absl::StatusOr<std::unique_ptr<Target>> target =
        ConnectTarget(options_, connections, {RequestNamed("one"), RequestNamed("two")});
    EXPECT_TRUE(target.ok()) << target.status();
    return *std::move(target);
  }

  static EndedCall Await(Target& target) {
    for (;;) {
      std::vector<EndedCall> ended = target.Wait(target.Now() + std::chrono::hours(1));
      if (!ended.empty()) return ended.front();
    }
  }

  FakeServer server_;
  client::ClientOptions options_;
};

TEST_F(GrpcTargetTest, ReportsTheStatusOfACall) {
  server_.service().on_synthesize = [](auto*, const auto&, auto* writer) {
    WriteReply(kFrames, true, writer);
    return grpc::Status::OK;
  };
  const std::unique_ptr<Target> target = Connect();
  const Time before = target->Now();
  target->Start(7, 0);
  const EndedCall ended = Await(*target);
  EXPECT_EQ(ended.id, 7);
  EXPECT_EQ(ended.code, absl::StatusCode::kOk);
  EXPECT_EQ(ended.frames, kFrames);
  ASSERT_TRUE(ended.first_chunk.has_value());
  EXPECT_LE(before, *ended.first_chunk);
  EXPECT_LE(*ended.first_chunk, ended.end);
}

TEST_F(GrpcTargetTest, IncompleteReplyIsInternal) {
  for (const auto& [frames, with_summary] : {std::pair(30, true), std::pair(kFrames, false)}) {
    server_.service().on_synthesize = [frames = frames, with_summary = with_summary](
                                          auto*, const auto&, auto* writer) {
      WriteReply(frames, with_summary, writer);
      return grpc::Status::OK;
    };
    const std::unique_ptr<Target> target = Connect();
    target->Start(1, 0);
    EXPECT_EQ(Await(*target).code, absl::StatusCode::kInternal);
  }
}

TEST_F(GrpcTargetTest, RejectionsKeepTheirCodeAndAreNotRetried) {
  std::atomic<int> calls{0};
  server_.service().on_synthesize = [&calls](auto*, const auto&, auto*) {
    ++calls;
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "later");
  };
  const std::unique_ptr<Target> target = Connect();
  target->Start(1, 0);
  const EndedCall ended = Await(*target);
  EXPECT_EQ(ended.code, absl::StatusCode::kUnavailable);
  EXPECT_FALSE(ended.first_chunk.has_value());
  EXPECT_EQ(calls, 1);
}

TEST_F(GrpcTargetTest, EachKindHasItsRequest) {
  absl::Mutex mutex;
  std::vector<std::string> models;
  server_.service().on_synthesize = [&](auto*, const auto& request, auto*) {
    const absl::MutexLock lock(&mutex);
    models.push_back(request.model().name());
    return grpc::Status::OK;
  };
  const std::unique_ptr<Target> target = Connect();
  for (const std::size_t kind : {1, 0, 1}) {
    target->Start(1, kind);
    Await(*target);
  }
  EXPECT_THAT(models, ::testing::ElementsAre("two", "one", "two"));
}

TEST_F(GrpcTargetTest, CallsTakeConnectionsInTurn) {
  absl::Mutex mutex;
  std::set<std::string> peers;
  server_.service().on_synthesize = [&](auto* context, const auto&, auto*) {
    const absl::MutexLock lock(&mutex);
    peers.insert(context->peer());
    return grpc::Status::OK;
  };
  const std::unique_ptr<Target> target = Connect(3);
  for (int i = 0; i < 6; ++i) {
    target->Start(i, 0);
    Await(*target);
  }
  EXPECT_EQ(peers.size(), 3U);
}

TEST_F(GrpcTargetTest, CancelledCallsEndAndNothingOutlivesIt) {
  std::atomic<int> begun{0};
  server_.service().on_synthesize = [&begun](auto* context, const auto&, auto*) {
    ++begun;
    while (!context->IsCancelled()) std::this_thread::yield();
    return grpc::Status::CANCELLED;
  };
  std::unique_ptr<Target> target = Connect();
  target->Start(1, 0);
  target->Start(2, 0);
  while (begun < 2) std::this_thread::yield();
  target->CancelAll();
  EXPECT_EQ(Await(*target).code, absl::StatusCode::kCancelled);
  target->Start(3, 0);
  while (begun < 3) std::this_thread::yield();
  target.reset();  // with one under way
}

// gRPC's thread that releases the last reference to a connection uses freed memory.
TEST_F(GrpcTargetTest, ReleasesACallBeforeItReportsTheEnd) {
  server_.service().on_synthesize = [](auto*, const auto&, auto* writer) {
    WriteReply(kFrames, true, writer);
    return grpc::Status::OK;
  };
  absl::Notification reported, released;
  bool reported_first = false;
  const test::ContextEnds ends([&] {
    // Time for a call to be reported that is not released yet.
    reported_first = reported.WaitForNotificationWithTimeout(absl::Milliseconds(200));
    released.Notify();
  });
  const std::unique_ptr<Target> target = Connect();
  target->Start(1, 0);
  Await(*target);
  reported.Notify();
  released.WaitForNotification();
  EXPECT_FALSE(reported_first);
}

TEST_F(GrpcTargetTest, SendsItsToken) {
  std::string authorization;
  server_.service().on_synthesize = [&](auto* context, const auto&, auto*) {
    const auto& metadata = context->client_metadata();
    const auto found = metadata.find("authorization");
    if (found != metadata.end()) {
      authorization.assign(found->second.data(), found->second.size());
    }
    return grpc::Status::OK;
  };
  options_.token = "secret";
  const std::unique_ptr<Target> target = Connect();
  target->Start(1, 0);
  Await(*target);
  EXPECT_EQ(authorization, "Bearer secret");
}

TEST(ConnectTargetTest, UnreachableServerIsAnError) {
  client::ClientOptions options;
  options.server_address = "unix:/nowhere/duet.sock";
  options.deadline = absl::Milliseconds(50);
  const absl::Status status = ConnectTarget(options, 1, {""}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), ::testing::HasSubstr("/nowhere/duet.sock"));
}

}  // namespace
}  // namespace duet::contrib::load
