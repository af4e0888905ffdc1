#include "server/service/live_replies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "server/service/wire.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using absl::StatusCode;

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

class LiveRepliesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    absl::StatusOr<ValidatedLiveStart> valid =
        ValidateLiveStart(test::SampleLiveStart(), model_->description(), RequestLimits());
    ASSERT_THAT(valid, IsOk());
    LiveSessionParts parts;
    parts.model = model_;
    parts.scheduler = &scheduler_;
    parts.clock = &clock_;
    parts.buffered_frames = 10;
    v1::LiveHeader header = MakeLiveHeader(model_->description(), *valid);
    session_ = std::make_shared<LiveSession>(std::move(parts), *std::move(valid));
    replies_ = std::make_unique<LiveReplies>(session_, std::move(header), model_,
                                             engine::SynthesisOptions(), clock_);
    ASSERT_THAT(replies_->Start({[] {}, [](double) { return true; }}), IsOk());
  }

  // Sends bytes, and returns the error of the session.
  absl::Status Send(const std::string& bytes) {
    const grpc::Slice slice(bytes);
    replies_->OnMessage(grpc::ByteBuffer(&slice, 1));
    return session_->Take().error;
  }

  test::FakeClock clock_;
  test::PuppetScheduler scheduler_;
  std::shared_ptr<test::FakeSynthesizer> model_ =
      std::make_shared<test::FakeSynthesizer>(test::SamplingDescription());
  std::shared_ptr<LiveSession> session_;
  std::unique_ptr<LiveReplies> replies_;
};

TEST_F(LiveRepliesTest, MessagesReachTheSession) {
  v1::SynthesizeLiveRequest message;
  *message.mutable_frames() = test::SampleLeaderFrames(0, 1);
  replies_->OnMessage(SerializeMessage(message));
  scheduler_.RunNext();
  EXPECT_TRUE(session_->Take().frames.has_value());
  replies_->OnDraining();
  EXPECT_TRUE(session_->Take().notice.has_value());
  replies_->OnEndOfMessages();
  EXPECT_TRUE(session_->Take().end);
}

TEST_F(LiveRepliesTest, ATooLargeMessageEndsTheSessionUnparsed) {
  EXPECT_THAT(Send(std::string(kMaxBytes, '\0')),
              StatusIs(StatusCode::kInvalidArgument, ::testing::_));
  SetUp();
  EXPECT_THAT(Send(std::string(kMaxBytes + 1, '\0')),
              StatusIs(StatusCode::kResourceExhausted,
                       HasSubstr("message of a live session: expected at most 1048576 bytes, got "
                                 "1048577")));
}

TEST_F(LiveRepliesTest, ManyTinyFieldsEndTheSessionUnparsed) {
  // Label changes, each with a vector, each with an empty weight: four bytes that take 150 parsed.
  std::string bomb;
  for (int i = 0; i < 100'000; ++i) bomb.append("\x1a\x02\x12\x00", 4);
  EXPECT_THAT(Send(bomb), StatusIs(StatusCode::kInvalidArgument, HasSubstr("label_change")));
}

}  // namespace
}  // namespace duet::server::service
