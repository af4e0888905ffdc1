// Who decides whether a follower is cleaned up: the request, else the operator, else the model.

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/common/mutex.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::server::service {
namespace {

using test::Call;
using test::FakeDescription;
using test::FakeSynthesizer;
using test::Reply;
using test::RunningService;
using test::SampleRequest;
using test::SamplingDescription;

// A service whose model notes what each of its windows was told.
class Service {
 public:
  Service(engine::ModelDescription model, std::optional<bool> operators_choice) {
    auto noting = std::make_shared<FakeSynthesizer>(std::move(model));
    noting->on_batch = [this](absl::Span<const engine::SynthesisWindow* const> windows) {
      common::MutexLock lock(mutex_);
      for (const engine::SynthesisWindow* window : windows)
        told_.push_back(window->options.clean_up);
    };
    RunningService::Setup setup;
    setup.model = std::move(noting);
    setup.clean_up = operators_choice;
    running_ = std::make_unique<RunningService>(setup);
  }

  // Makes a call of several windows. What the header says, where every window was told the same.
  std::optional<v1::CleanUp> Ask(v1::CleanUp wanted) {
    v1::SynthesizeRequest request = SampleRequest(120);
    request.set_clean_up(wanted);
    const Reply reply = Call(running_->stub(), request);
    EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
    if (!reply.status.ok()) return std::nullopt;
    const v1::CleanUp said = reply.messages.front().header().clean_up();
    common::MutexLock lock(mutex_);
    EXPECT_GT(told_.size(), 1u);
    for (const std::optional<bool>& told : told_) EXPECT_EQ(told, said == v1::CLEAN_UP_ON);
    told_.clear();
    return said;
  }

  RunningService& running() { return *running_; }

 private:
  common::Mutex mutex_;
  std::vector<std::optional<bool>> told_ DUET_GUARDED_BY(mutex_);
  std::unique_ptr<RunningService> running_;
};

TEST(CleanUpChoiceTest, DefaultDependsOnWhetherTheModelSamples) {
  EXPECT_EQ(Service(SamplingDescription(), std::nullopt).Ask(v1::CLEAN_UP_UNSPECIFIED),
            v1::CLEAN_UP_ON);
  EXPECT_EQ(Service(FakeDescription(), std::nullopt).Ask(v1::CLEAN_UP_UNSPECIFIED),
            v1::CLEAN_UP_OFF);
}

TEST(CleanUpChoiceTest, TheOperatorWinsOverTheModel) {
  EXPECT_EQ(Service(SamplingDescription(), false).Ask(v1::CLEAN_UP_UNSPECIFIED), v1::CLEAN_UP_OFF);
  EXPECT_EQ(Service(FakeDescription(), true).Ask(v1::CLEAN_UP_UNSPECIFIED), v1::CLEAN_UP_ON);
}

TEST(CleanUpChoiceTest, TheRequestWinsOverBoth) {
  Service never(SamplingDescription(), false);
  EXPECT_EQ(never.Ask(v1::CLEAN_UP_ON), v1::CLEAN_UP_ON);
  EXPECT_EQ(never.Ask(v1::CLEAN_UP_OFF), v1::CLEAN_UP_OFF) << "the call before has no say";
  Service always(FakeDescription(), true);
  EXPECT_EQ(always.Ask(v1::CLEAN_UP_OFF), v1::CLEAN_UP_OFF);
}

TEST(CleanUpChoiceTest, TheCallsRecordTells) {
  Service service(FakeDescription(), std::nullopt);
  service.Ask(v1::CLEAN_UP_ON);
  EXPECT_TRUE(service.running().calls().WaitFor(1).clean_up);
  service.Ask(v1::CLEAN_UP_OFF);
  EXPECT_FALSE(service.running().calls().WaitFor(2).clean_up);
}

}  // namespace
}  // namespace duet::server::service
