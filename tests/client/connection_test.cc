#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/internal/connect.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_stub.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

using test::ChunkFor;
using test::FakeStub;
using test::FakeTime;
using test::FollowerFor;
using test::HeaderFor;
using test::ReplyFor;
using test::ScriptedStream;
using test::ServiceError;
using test::ThreeJointLeader;

using Reply = std::vector<v1::SynthesizeResponse>;

class ConnectionTest : public ::testing::Test {
 protected:
  ConnectionTest() {
    request_.leader = ThreeJointLeader(5);
    request_.weights = {{"kick", 1}};
    options_.deadline = absl::Seconds(30);
  }

  absl::StatusOr<SynthesisResult> Synthesize(const ChunkCallback& on_chunk = nullptr) {
    return ConnectionImpl(stub_, options_, time_.Environment()).Synthesize(request_, on_chunk);
  }

  ScriptedStream Good(int chunk_frames = 2) {
    return {ReplyFor(request_.leader, chunk_frames), absl::OkStatus()};
  }
  // Breaks after the header and the first two frames.
  ScriptedStream Broken() {
    return {{HeaderFor(request_.leader), ChunkFor(request_.leader, 0, 2)},
            absl::UnavailableError("connection reset")};
  }
  static ScriptedStream Refused(const absl::Status& status) { return {{}, status}; }

  std::shared_ptr<FakeStub> stub_ = std::make_shared<FakeStub>();
  ClientOptions options_;
  FakeTime time_;
  SynthesisRequest request_;
};

TEST_F(ConnectionTest, EveryAttemptCarriesTheSameDeadlineAndRequestId) {
  request_.request_id = "mine";
  stub_->streams = {Refused(absl::UnavailableError("away")), Good()};
  const absl::Time deadline = time_.now + options_.deadline;
  ASSERT_THAT(Synthesize(), IsOk());
  ASSERT_THAT(stub_->contexts, SizeIs(2));
  EXPECT_THAT(stub_->contexts, Each(Field(&CallContext::deadline, deadline)));
  EXPECT_THAT(stub_->contexts, Each(Field(&CallContext::request_id, "mine")));
}

TEST_F(ConnectionTest, RefusesARequestIdThatMetadataCannotCarry) {
  for (const std::string& id : {std::string("caf\xc3\xa9"), std::string("a\nb"),
                                std::string("two words"), std::string(129, 'x')}) {
    request_.request_id = id;
    const auto refused = StatusIs(absl::StatusCode::kInvalidArgument,
                                  ::testing::StartsWith("request_id: expected 1 to 128 printable "
                                                        "ASCII characters without spaces, got "));
    EXPECT_THAT(Synthesize(), refused);
    absl::Status ended;
    ConnectionImpl(stub_, options_, time_.Environment())
        .SynthesizeAsync(request_, [&ended](const absl::StatusOr<SynthesisResult>& result) {
          ended = result.status();
        });
    EXPECT_THAT(ended, refused);
  }
  EXPECT_THAT(stub_->contexts, ::testing::IsEmpty());
}

TEST_F(ConnectionTest, BrokenStreamIsRetried) {
  stub_->streams = {Broken(), Good()};
  const absl::StatusOr<SynthesisResult> result = Synthesize();
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->pair.follower.poses, FollowerFor(request_.leader));
  EXPECT_EQ(result->attempt_count, 2);
  EXPECT_THAT(time_.sleeps, ElementsAre(absl::Milliseconds(50)));
}

TEST_F(ConnectionTest, MalformedReplyIsCancelledAndNotRetried) {
  ScriptedStream malformed = Good();
  malformed.responses.erase(malformed.responses.begin() + 1);
  stub_->streams = {malformed};
  EXPECT_THAT(Synthesize(), StatusIs(absl::StatusCode::kInternal, HasSubstr("chunk.first_frame")));
  EXPECT_EQ(stub_->cancelled, 1);
}

TEST_F(ConnectionTest, AsynchronousCallIsNotRetried) {
  std::vector<absl::StatusOr<SynthesisResult>> results;
  const auto done = [&results](absl::StatusOr<SynthesisResult> result) {
    results.push_back(std::move(result));
  };
  ScriptedStream malformed = Good();
  malformed.responses.erase(malformed.responses.begin() + 1);
  stub_->streams = {Good(), Broken(), Refused(absl::UnavailableError("away")), malformed};
  ConnectionImpl connection(stub_, options_, time_.Environment());
  for (int call = 0; call < 4; ++call) connection.SynthesizeAsync(request_, done);
  request_.chunk_frames = 0;
  connection.SynthesizeAsync(request_, done);
  ASSERT_THAT(results, SizeIs(5));
  ASSERT_THAT(results[0], IsOk());
  EXPECT_EQ(results[0]->pair.follower.poses, FollowerFor(request_.leader));
  EXPECT_EQ(results[0]->attempt_count, 1);
  EXPECT_THAT(results[1], StatusIs(absl::StatusCode::kUnavailable, HasSubstr("after 2 of 5")));
  EXPECT_THAT(results[2], StatusIs(absl::StatusCode::kUnavailable,
                                   "the server at localhost:50051 cannot be reached: away"));
  EXPECT_THAT(results[3], StatusIs(absl::StatusCode::kInternal, HasSubstr("chunk.first_frame")));
  EXPECT_EQ(stub_->cancelled, 1);
  EXPECT_THAT(results[4], StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("chunk_frames")));
  EXPECT_THAT(time_.sleeps, SizeIs(0));
}

TEST_F(ConnectionTest, CallbackGetsEveryFrameOnceAcrossRetries) {
  stub_->streams = {Broken(), Good(3)};
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
  stub_->streams = {Broken(), Refused(absl::UnavailableError("away")), Good()};
  ASSERT_THAT(Synthesize([](const FollowerChunk&) { return absl::OkStatus(); }), IsOk());
  ASSERT_THAT(stub_->synthesize_requests, SizeIs(3));
  EXPECT_EQ(stub_->synthesize_requests[0].model().name(), "");
  for (int attempt : {1, 2}) {
    const auto& selector = stub_->synthesize_requests[static_cast<size_t>(attempt)].model();
    EXPECT_EQ(selector.name(), "dancer");
    EXPECT_EQ(selector.version(), 1u);
  }
}

TEST_F(ConnectionTest, ModelThatIsNoLongerServedIsReported) {
  stub_->streams = {Broken(), Refused(absl::NotFoundError("no version 1"))};
  EXPECT_THAT(Synthesize([](const FollowerChunk&) { return absl::OkStatus(); }),
              StatusIs(absl::StatusCode::kAborted,
                       HasSubstr("broke after 2 frames and cannot be resumed: dancer@1")));
}

TEST_F(ConnectionTest, TheCallbackEndsTheCallWithItsOwnStatus) {
  stub_->streams = {Good()};
  int chunks = 0;
  // Not even a code that is otherwise retried.
  EXPECT_THAT(Synthesize([&](const FollowerChunk&) {
                ++chunks;
                return absl::UnavailableError("enough");
              }),
              StatusIs(absl::StatusCode::kUnavailable, "enough"));
  EXPECT_EQ(chunks, 1);
  EXPECT_EQ(stub_->cancelled, 1);
}

TEST_F(ConnectionTest, CallsThatReadModelsAreRetried) {
  v1::ListModelsResponse listed;
  listed.add_models()->set_name("first");
  listed.add_models()->set_name("second");
  stub_->list_models = {absl::UnavailableError("loading"), listed};
  const auto models = ConnectionImpl(stub_, options_, time_.Environment()).ListModels();
  ASSERT_THAT(models, IsOk());
  EXPECT_THAT(*models,
              ElementsAre(Field(&ModelInfo::name, "first"), Field(&ModelInfo::name, "second")));
  v1::GetModelResponse response;
  response.mutable_model()->set_name("dancer");
  response.mutable_limits()->set_min_frames(2);
  stub_->get_model = {absl::UnavailableError("loading"), response};
  const auto details =
      ConnectionImpl(stub_, options_, time_.Environment()).GetModel({"dancer", 2, ""});
  ASSERT_THAT(details, IsOk());
  EXPECT_EQ(details->model.name, "dancer");
  EXPECT_EQ(details->limits.min_frames, 2);
  EXPECT_EQ(stub_->get_model_requests[1].model().version(), 2u);
}

}  // namespace
}  // namespace duet::client::internal
