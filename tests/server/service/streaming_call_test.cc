// StreamingCall with a source that the test controls. clip_replies_test.cc tests it with the source
// of Synthesize.
#include "server/service/streaming_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "duet/v1/model.pb.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/recording_observer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::FakeClock;
using test::RecordingObserver;

using ::testing::_;

using absl::StatusCode;

// What the test sees of a source that the call owns.
struct SourceState {
  absl::Status start;
  std::deque<std::string> ready;  // names of the next replies
  std::optional<absl::Status> end;
  std::function<void()> on_progress;
  bool cancelled = false;
  int reports = 0;
};

// Any message can be a reply: here a ModelSelector with a name.
class PuppetSource final : public ReplySource {
 public:
  explicit PuppetSource(SourceState& state) : state_(state) {}

  absl::Status Start(std::function<void()> on_progress) override {
    state_.on_progress = std::move(on_progress);
    return state_.start;
  }
  NextReply Next(CallScope&) override {
    if (state_.ready.empty()) return {nullptr, state_.end};
    reply_.set_name(state_.ready.front());
    state_.ready.pop_front();
    return {&reply_, {}};
  }
  void Cancel() override { state_.cancelled = true; }
  void Report(metrics::CallRecord& record) const override {
    ++state_.reports;
    record.model = "puppet";
  }

 private:
  SourceState& state_;
  v1::ModelSelector reply_;
};

class FakeWriter final : public ReplyWriter {
 public:
  void Write(const google::protobuf::Message& reply) override {
    EXPECT_FALSE(writing) << "two writes at once";
    writing = true;
    written.push_back(dynamic_cast<const v1::ModelSelector&>(reply).name());
  }
  void Finish(CallScope& scope, const absl::Status& status) override {
    EXPECT_FALSE(writing) << "the end during a write";
    EXPECT_FALSE(finished.has_value()) << "two ends";
    scope.Finish(status);
    finished = status;
  }
  void BreakOff(const absl::Status&) override { ++broken_off; }

  bool writing = false;
  int broken_off = 0;
  std::vector<std::string> written;
  std::optional<absl::Status> finished;
};

class StreamingCallTest : public ::testing::Test {
 protected:
  StreamingCallTest() {
    StreamingCall::Parts parts;
    parts.scope =
        std::make_unique<CallScope>(metrics::MethodInfo{"service", "Method", "bidi_stream"},
                                    CallIdentity{"id", "", "peer", "client"}, observers_, clock_);
    parts.deadline = clock_.Now() + std::chrono::seconds(60);
    parts.write_timeout_seconds = 30;
    parts.clock = &clock_;
    call_ =
        StreamingCall::Create(std::move(parts), std::make_unique<PuppetSource>(source_), writer_);
  }

  void Written(bool ok = true) {
    ASSERT_TRUE(writer_.writing);
    writer_.writing = false;
    call_->OnWritten(ok);
  }
  void Progress(std::string reply) {
    source_.ready.push_back(std::move(reply));
    source_.on_progress();
  }

  FakeClock clock_;
  RecordingObserver observer_;
  std::vector<metrics::CallObserver*> observers_ = {&observer_};
  SourceState source_;
  FakeWriter writer_;
  std::shared_ptr<StreamingCall> call_;
};

TEST_F(StreamingCallTest, WritesEachReplyOnceItIsReady) {
  call_->Start();
  EXPECT_THAT(writer_.written, IsEmpty());
  Progress("one");
  EXPECT_THAT(writer_.written, ElementsAre("one"));
  Progress("two");
  EXPECT_THAT(writer_.written, ElementsAre("one")) << "the first write is not over";
  Written();
  EXPECT_THAT(writer_.written, ElementsAre("one", "two"));
  Written();
  EXPECT_FALSE(writer_.finished.has_value()) << "the source has not ended";
}

TEST_F(StreamingCallTest, EndsWithTheStatusOfItsSource) {
  source_.ready = {"last"};
  source_.end = absl::OkStatus();
  call_->Start();
  Written();
  EXPECT_THAT(*writer_.finished, IsOk());
  EXPECT_EQ(source_.reports, 1);
  EXPECT_EQ(observer_.WaitFor(1).model, "puppet");
}

TEST_F(StreamingCallTest, SourceThatDoesNotStartEndsTheCallBeforeAnyReply) {
  source_.start = absl::ResourceExhaustedError("full");
  source_.ready = {"never"};
  call_->Start();
  EXPECT_THAT(writer_.written, IsEmpty());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kResourceExhausted, "full"));
}

TEST_F(StreamingCallTest, AbortCancelsTheSourceAndDropsItsReplies) {
  call_->Start();
  Progress("one");
  Progress("two");
  call_->Abort(absl::CancelledError("gone"));
  EXPECT_TRUE(source_.cancelled);
  EXPECT_FALSE(writer_.finished.has_value()) << "a write is in progress";
  Written();
  EXPECT_THAT(writer_.written, ElementsAre("one"));
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

TEST_F(StreamingCallTest, IdleCallEndsAtItsDeadline) {
  call_->Start();
  clock_.Advance(std::chrono::seconds(60));
  call_->CheckTime(clock_.Now());
  EXPECT_TRUE(source_.cancelled);
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded, _));
}

TEST_F(StreamingCallTest, WriteOfAStalledReaderIsBrokenOff) {
  call_->Start();
  Progress("one");
  clock_.Advance(std::chrono::seconds(30));
  call_->CheckTime(clock_.Now());
  EXPECT_EQ(writer_.broken_off, 1);
  EXPECT_TRUE(source_.cancelled);
  Written(/*ok=*/false);
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded, _));
}

TEST_F(StreamingCallTest, ProgressAfterTheCallIsGoneIsIgnored) {
  call_->Start();
  call_->Abort(absl::CancelledError("gone"));
  const std::function<void()> on_progress = source_.on_progress;
  call_.reset();
  on_progress();
  EXPECT_THAT(writer_.written, IsEmpty());
}

}  // namespace
}  // namespace duet::server::service
