// Calls and their retries over a real connection to an in-process server, with a fake clock.
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "absl/synchronization/notification.h"
#include "absl/time/time.h"
#include "client/internal/connect.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

using test::ChunkFor;
using test::FakeServer;
using test::FakeTime;
using test::FollowerFor;
using test::HeaderFor;
using test::ReplyFor;
using test::ThreeJointLeader;

using Reply = std::vector<v1::SynthesizeResponse>;
using Writer = grpc::ServerWriter<v1::SynthesizeResponse>;

// What one stream brings, and how it ends.
struct ScriptedStream {
  Reply responses;
  grpc::Status end;
  // Sends the last response again and again, until the client cancels the stream.
  bool until_cancelled = false;
};

grpc::Status Away() { return {grpc::StatusCode::UNAVAILABLE, "away"}; }

class ConnectionTest : public ::testing::Test {
 protected:
  ConnectionTest() {
    request_.leader = ThreeJointLeader(5);
    request_.weights = {{"kick", 1}};
    options_.server_address = server_.address();
    server_.service().on_synthesize = [this](grpc::ServerContext* context,
                                             const v1::SynthesizeRequest& request, Writer* writer) {
      return Play(*context, request, writer);
    };
  }

  std::unique_ptr<ConnectionImpl> Connect() {
    return std::make_unique<ConnectionImpl>(*OpenChannel(options_), options_, time_.Environment());
  }
  absl::StatusOr<SynthesisResult> Synthesize(const ChunkCallback& on_chunk = nullptr) {
    return Connect()->Synthesize(request_, on_chunk);
  }
  absl::StatusOr<SynthesisResult> SynthesizeAsync() {
    absl::StatusOr<SynthesisResult> result;
    absl::Notification ended;
    Connect()->SynthesizeAsync(request_, [&](absl::StatusOr<SynthesisResult> ends) {
      result = std::move(ends);
      ended.Notify();
    });
    ended.WaitForNotification();
    return result;
  }

  ScriptedStream Good(int chunk_frames = 2) {
    return {ReplyFor(request_.leader, chunk_frames), grpc::Status::OK};
  }
  // Breaks after the header and the first two frames.
  ScriptedStream Broken() {
    return {{HeaderFor(request_.leader), ChunkFor(request_.leader, 0, 2)},
            {grpc::StatusCode::UNAVAILABLE, "connection reset"}};
  }
  // Lacks the first two frames.
  ScriptedStream Malformed() {
    return {{HeaderFor(request_.leader), ChunkFor(request_.leader, 2, 2)}, {}, true};
  }
  static ScriptedStream Refused(const grpc::Status& status) { return {{}, status}; }

  struct Attempt {
    v1::SynthesizeRequest request;
    absl::Time deadline;
    std::string request_id;
  };
  // Of the calls of Synthesize.
  std::vector<Attempt> attempts() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return attempts_;
  }

 private:
  grpc::Status Play(const grpc::ServerContext& context, const v1::SynthesizeRequest& request,
                    Writer* writer) {
    ScriptedStream script{{}, {grpc::StatusCode::INTERNAL, "not scripted"}};
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (attempts_.size() < streams_.size()) script = streams_[attempts_.size()];
      const auto id = context.client_metadata().find("x-request-id");
      attempts_.push_back({request, absl::FromChrono(context.deadline()),
                           id == context.client_metadata().end()
                               ? ""
                               : std::string(id->second.begin(), id->second.end())});
    }
    for (const v1::SynthesizeResponse& response : script.responses) writer->Write(response);
    while (script.until_cancelled && writer->Write(script.responses.back())) {
    }
    return script.end;
  }

  std::mutex mutex_;
  std::vector<Attempt> attempts_;

 protected:
  std::vector<ScriptedStream> streams_;  // one for each attempt
  FakeServer server_;                    // its handlers use the members above
  ClientOptions options_;
  FakeTime time_;
  SynthesisRequest request_;
};

TEST_F(ConnectionTest, EveryAttemptCarriesTheSameDeadlineAndRequestId) {
  request_.request_id = "mine";
  options_.deadline = absl::Hours(2);
  options_.retry.initial_backoff = options_.retry.max_backoff = absl::Hours(1);
  streams_ = {Refused(Away()), Good()};
  const absl::Time deadline = time_.now + options_.deadline;
  ASSERT_THAT(Synthesize(), IsOk());
  ASSERT_THAT(attempts(), SizeIs(2));
  for (const Attempt& attempt : attempts()) {
    EXPECT_EQ(attempt.request_id, "mine");
    // A deadline travels as the time that is left.
    EXPECT_LT(absl::AbsDuration(attempt.deadline - deadline), absl::Minutes(10));
  }
}

TEST_F(ConnectionTest, RefusesARequestIdThatMetadataCannotCarry) {
  for (const std::string& id : {std::string("caf\xc3\xa9"), std::string("a\nb"),
                                std::string("two words"), std::string(129, 'x')}) {
    request_.request_id = id;
    const auto refused = StatusIs(absl::StatusCode::kInvalidArgument,
                                  ::testing::StartsWith("request_id: expected 1 to 128 printable "
                                                        "ASCII characters without spaces, got "));
    EXPECT_THAT(Synthesize(), refused);
    EXPECT_THAT(SynthesizeAsync(), refused);
  }
  EXPECT_THAT(attempts(), ::testing::IsEmpty());
}

TEST_F(ConnectionTest, BrokenStreamIsRetried) {
  streams_ = {Broken(), Good()};
  const absl::StatusOr<SynthesisResult> result = Synthesize();
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->pair.follower.poses, FollowerFor(request_.leader));
  EXPECT_EQ(result->attempt_count, 2);
  EXPECT_THAT(time_.sleeps, ElementsAre(absl::Milliseconds(50)));
}

TEST_F(ConnectionTest, MalformedReplyIsCancelledAndNotRetried) {
  streams_ = {Malformed()};  // would never end
  EXPECT_THAT(Synthesize(), StatusIs(absl::StatusCode::kInternal, HasSubstr("chunk.first_frame")));
  EXPECT_THAT(attempts(), SizeIs(1));
}

TEST_F(ConnectionTest, AsynchronousCallIsNotRetried) {
  streams_ = {Good(), Broken(), Refused(Away()), Malformed()};
  const absl::StatusOr<SynthesisResult> result = SynthesizeAsync();
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->pair.follower.poses, FollowerFor(request_.leader));
  EXPECT_EQ(result->attempt_count, 1);
  EXPECT_THAT(SynthesizeAsync(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("after 2 of 5")));
  EXPECT_THAT(SynthesizeAsync(),
              StatusIs(absl::StatusCode::kUnavailable,
                       "the server at " + server_.address() + " cannot be reached: away"));
  EXPECT_THAT(SynthesizeAsync(),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("chunk.first_frame")));
  request_.chunk_frames = 0;
  EXPECT_THAT(SynthesizeAsync(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("chunk_frames")));
  EXPECT_THAT(attempts(), SizeIs(4));
  EXPECT_THAT(time_.sleeps, SizeIs(0));
}

TEST_F(ConnectionTest, CallbackGetsEveryFrameOnceAcrossRetries) {
  streams_ = {Broken(), Good(3)};
  motion::Poses frames(0, request_.leader.joint_count());
  const absl::StatusOr<SynthesisResult> result = Synthesize([&](const FollowerChunk& chunk) {
    EXPECT_EQ(chunk.first_frame, frames.frame_count());
    frames.Append(chunk.poses.all());
    return absl::OkStatus();
  });
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(frames, FollowerFor(request_.leader));
}

TEST_F(ConnectionTest, AResumedStreamComesFromTheSameModelVersion) {
  streams_ = {Broken(), Refused(Away()), Good()};
  ASSERT_THAT(Synthesize([](const FollowerChunk&) { return absl::OkStatus(); }), IsOk());
  ASSERT_THAT(attempts(), SizeIs(3));
  EXPECT_EQ(attempts()[0].request.model().name(), "");
  for (size_t attempt : {1, 2}) {
    const v1::ModelSelector selector = attempts()[attempt].request.model();
    EXPECT_EQ(selector.name(), "dancer");
    EXPECT_EQ(selector.version(), 1u);
  }
}

TEST_F(ConnectionTest, ModelThatIsNoLongerServedIsReported) {
  streams_ = {Broken(), Refused({grpc::StatusCode::NOT_FOUND, "no version 1"})};
  EXPECT_THAT(Synthesize([](const FollowerChunk&) { return absl::OkStatus(); }),
              StatusIs(absl::StatusCode::kAborted,
                       HasSubstr("broke after 2 frames and cannot be resumed: dancer@1")));
}

TEST_F(ConnectionTest, TheCallbackEndsTheCallWithItsOwnStatus) {
  streams_ = {Good()};
  streams_[0].until_cancelled = true;
  int chunks = 0;
  // Not even a code that is otherwise retried.
  EXPECT_THAT(Synthesize([&](const FollowerChunk&) {
                ++chunks;
                return absl::UnavailableError("enough");
              }),
              StatusIs(absl::StatusCode::kUnavailable, "enough"));
  EXPECT_EQ(chunks, 1);
}

TEST_F(ConnectionTest, CallsThatReadModelsAreRetried) {
  int calls = 0;
  server_.service().on_list_models = [&](grpc::ServerContext*, v1::ListModelsResponse* response) {
    if (calls++ == 0) return Away();
    response->add_models()->set_name("first");
    response->add_models()->set_name("second");
    return grpc::Status::OK;
  };
  const auto models = Connect()->ListModels();
  ASSERT_THAT(models, IsOk());
  EXPECT_THAT(*models,
              ElementsAre(Field(&ModelInfo::name, "first"), Field(&ModelInfo::name, "second")));
  server_.service().on_get_model = [&](const v1::GetModelRequest& request,
                                       v1::GetModelResponse* response) {
    if (calls++ == 2) return Away();
    EXPECT_EQ(request.model().version(), 2u);
    response->mutable_model()->set_name("dancer");
    response->mutable_limits()->set_min_frames(2);
    return grpc::Status::OK;
  };
  const auto details = Connect()->GetModel({"dancer", 2, ""});
  ASSERT_THAT(details, IsOk());
  EXPECT_EQ(details->model.name, "dancer");
  EXPECT_EQ(details->limits.min_frames, 2);
}

}  // namespace
}  // namespace duet::client::internal
