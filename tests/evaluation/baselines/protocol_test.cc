#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "model/evaluation/baselines/baselines.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::baselines {
namespace {

using test::MadeUpPairs;

// Answers with the leader moved, and writes down what it was given.
class Recorder : public Method {
 public:
  std::string name() const override { return "recorder"; }
  absl::Status Train(const dataset::Dataset&, const std::vector<int>& train) override {
    trained.push_back(train);
    return status;
  }
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override {
    follower_frames.push_back(sequence.pair.follower.frame_count());
    motion::Poses answer = sequence.pair.leader.poses;
    if (spoil) spoil(&answer);
    if (!predict_status.ok()) return predict_status;
    return answer;
  }
  bool reads_first_pose() const override { return told_first_pose; }

  bool told_first_pose = false;
  absl::Status status;          // Train's
  absl::Status predict_status;  // Predict's
  std::function<void(motion::Poses*)> spoil;
  std::vector<std::vector<int>> trained;
  mutable std::vector<int> follower_frames;
};

// The fold without subject a.
absl::StatusOr<std::vector<metrics::ScoredMotion>> RunFoldA(const dataset::Dataset& dataset,
                                                            Method* method) {
  return RunFold(dataset, *LeaveSubjectOut(dataset, "a"), method);
}

TEST(ProtocolTest, TrainsAndAnswersTheSequencesOfTheSplit) {
  Recorder method;
  const auto fold = RunFoldA(MadeUpPairs(3), &method);
  ASSERT_THAT(fold, IsOk());
  EXPECT_THAT(method.trained[0], ElementsAre(1, 2, 4, 5));
  ASSERT_THAT(*fold, SizeIs(2));
  EXPECT_EQ((*fold)[1].sequence, 3);
}

TEST(ProtocolTest, MethodsDoNotSeeTheFollower) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  ASSERT_THAT(RunFoldA(dataset, &method), IsOk());
  EXPECT_THAT(method.follower_frames, ElementsAre(0, 0));
  method.told_first_pose = true;
  method.follower_frames.clear();
  ASSERT_THAT(RunFoldA(dataset, &method), IsOk());
  EXPECT_THAT(method.follower_frames, ElementsAre(1, 1));
}

TEST(ProtocolTest, InvalidAnswersAreErrorsThatNameMethodAndSequence) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  method.spoil = [](motion::Poses* answer) { answer->DropFront(1); };
  EXPECT_THAT(RunFoldA(dataset, &method),
              StatusIs(absl::StatusCode::kInternal,
                       HasSubstr("recorder: 0/0: answer: expected the leader's 16 frames "
                                 "of 15 joints, got 15 of 15")));
  method.spoil = [](motion::Poses* answer) { *answer = motion::Poses(16, 14); };
  EXPECT_THAT(RunFoldA(dataset, &method),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("got 16 of 14")));
  method.spoil = [](motion::Poses* answer) { answer->at(15, 14).y = std::nanf(""); };
  EXPECT_THAT(RunFoldA(dataset, &method),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("expected finite positions")));
}

TEST(ProtocolTest, FailuresNameMethodAndSequence) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  method.predict_status = absl::UnavailableError("the network failed");
  EXPECT_THAT(RunFoldA(dataset, &method), StatusIs(absl::StatusCode::kUnavailable,
                                                   HasSubstr("recorder: 0/0: the network failed")));
}

}  // namespace
}  // namespace duet::evaluation::baselines
