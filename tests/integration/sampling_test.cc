// Seed, variety, candidates and clean-up from the client library to a model that samples, over the
// wire and back.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "absl/status/statusor.h"
#include "client/client.h"
#include "model/engine/clip_synthesis.h"
#include "model/motion/skeleton.h"
#include "tests/server/support/running_service.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"

namespace duet::client {
namespace {

using test::FakeSynthesizer;
using test::IsOk;
using test::RunningService;
using test::SamplingDescription;
using test::StatusIs;
using test::SwayingMotion;

using ::testing::HasSubstr;

class ClientSamplingTest : public ::testing::Test {
 protected:
  ClientSamplingTest() {
    RunningService::Setup setup;
    setup.model = model_;
    running_ = std::make_unique<RunningService>(setup);
    request_.leader.joint_names = motion::SbuSkeleton().joint_names;
    request_.leader.frame_rate_hz = 30;
    request_.leader.poses = SwayingMotion(300, 30);  // 10 s: four windows
    request_.weights = {{"kick", 1}};
  }

  absl::StatusOr<SynthesisResult> Ask() {
    ClientOptions options;
    options.server_address = running_->address();
    const absl::StatusOr<Client> client = Client::Create(options);
    if (!client.ok()) return client.status();
    return client->Synthesize(request_);
  }

  absl::StatusOr<SynthesisResult> Ask(uint64_t seed, float variety) {
    request_.seed = seed;
    request_.variety = variety;
    return Ask();
  }

  std::shared_ptr<FakeSynthesizer> model_ =
      std::make_shared<FakeSynthesizer>(SamplingDescription());
  std::unique_ptr<RunningService> running_;
  SynthesisRequest request_;
};

TEST_F(ClientSamplingTest, SameSeedGivesTheSameBytesAndAnotherSeedDifferentOnes) {
  const auto seven = Ask(7, 1), again = Ask(7, 1), eight = Ask(8, 1);
  ASSERT_THAT(seven, IsOk());
  ASSERT_THAT(again, IsOk());
  ASSERT_THAT(eight, IsOk());
  EXPECT_EQ(seven->pair.follower.poses, again->pair.follower.poses);
  EXPECT_NE(seven->pair.follower.poses, eight->pair.follower.poses);
}

TEST_F(ClientSamplingTest, TheResultSaysWhatWasUsed) {
  const auto result = Ask(18446744073709551615u, 0.25f);
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->seed, 18446744073709551615u);
  EXPECT_EQ(result->variety, 0.25f);
}

TEST_F(ClientSamplingTest, ARequestThatSaysNothingHasTheSeedOfItsResultAndVarietyOne) {
  const auto plain = Ask();
  ASSERT_THAT(plain, IsOk());
  EXPECT_EQ(plain->variety, 1);
  EXPECT_EQ(plain->pair.follower.poses, Ask(plain->seed, 1)->pair.follower.poses);
}

TEST_F(ClientSamplingTest, TheResultSaysWhetherItWasCleanedUp) {
  EXPECT_TRUE(Ask()->cleaned_up);  // its model samples
  request_.clean_up = false;
  EXPECT_FALSE(Ask()->cleaned_up);
  request_.clean_up = true;
  EXPECT_TRUE(Ask()->cleaned_up);
}

TEST_F(ClientSamplingTest, TheResultHasCandidatesAndTheGrade) {
  EXPECT_EQ(Ask()->candidates, 1);
  request_.candidates = 16;
  const auto result = Ask();
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->candidates, 16);
  ASSERT_TRUE(result->grade.has_value());
  EXPECT_EQ(result->grade->overlapping, 0);
}

TEST_F(ClientSamplingTest, TooManyCandidatesAreRefusedByName) {
  request_.candidates = 17;
  EXPECT_THAT(Ask(), StatusIs(absl::StatusCode::kInvalidArgument,
                              HasSubstr("candidates: expected 1 to 16, got 17")));
}

TEST_F(ClientSamplingTest, TooMuchVarietyIsRefusedByName) {
  EXPECT_THAT(Ask(7, 2.5f), StatusIs(absl::StatusCode::kInvalidArgument,
                                     HasSubstr("variety: expected a finite value in [0, ")));
}

TEST_F(ClientSamplingTest, UnfamiliarityComesWithTheResultWhereTheModelKnows) {
  EXPECT_FALSE(Ask()->unfamiliarity.has_value());
  model_->unfamiliarity = [](const engine::ClipRequest& request) {
    return request.leader.frame_count() / 100.0;
  };
  EXPECT_EQ(Ask()->unfamiliarity, 3);
}

}  // namespace
}  // namespace duet::client
