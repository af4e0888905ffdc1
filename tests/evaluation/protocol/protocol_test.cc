#include "model/evaluation/protocol/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>

#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/status_matchers.h"

namespace duet::evaluation::protocol {
namespace {

using test::IsOk;
using test::MadeUpPairs;
using test::StatusIs;

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::chrono::microseconds kTraining(200);

// Answers with the leader moved, and writes down what it was given.
class Recorder : public Method {
 public:
  std::string name() const override { return "recorder"; }
  absl::Status Train(const dataset::Dataset&, const std::vector<int>& train) override {
    trained.push_back(train);
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < kTraining) {
    }
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

TEST(ProtocolTest, LeavesEachSubjectOutOnce) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  std::vector<std::string> heard;
  const auto folds = RunLeaveOneSubjectOut(
      dataset, {}, &method, [&](const FoldResult& fold) { heard.push_back(fold.subject); });
  ASSERT_THAT(folds, IsOk());
  EXPECT_THAT(heard, ElementsAre("a", "b", "c"));
  EXPECT_THAT(method.trained[0], ElementsAre(1, 2, 4, 5));
  ASSERT_EQ((*folds)[0].motions.size(), 2u);
  EXPECT_EQ((*folds)[0].motions[1].sequence, 3);
  EXPECT_GE((*folds)[0].train_seconds, std::chrono::duration<double>(kTraining).count());
  EXPECT_EQ(PoolMotions(*folds).size(), 6u);
}

TEST(ProtocolTest, MethodsDoNotSeeTheFollower) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  ASSERT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method), IsOk());
  EXPECT_THAT(method.follower_frames, ElementsAre(0, 0));
  method.told_first_pose = true;
  method.follower_frames.clear();
  ASSERT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method), IsOk());
  EXPECT_THAT(method.follower_frames, ElementsAre(1, 1));
}

TEST(ProtocolTest, InvalidAnswersAreErrorsThatNameMethodAndSequence) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  method.spoil = [](motion::Poses* answer) { answer->DropFront(1); };
  EXPECT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method),
              StatusIs(absl::StatusCode::kInternal,
                       HasSubstr("recorder: 0/0: 15 frames of 15 joints came, wanted 16 of 15")));
  method.spoil = [](motion::Poses* answer) { *answer = motion::Poses(16, 14); };
  EXPECT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("16 frames of 14 joints came")));
  method.spoil = [](motion::Poses* answer) { answer->at(15, 14).y = std::nanf(""); };
  EXPECT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("not finite")));
}

TEST(ProtocolTest, FailuresNameMethodAndSequence) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  method.predict_status = absl::UnavailableError("the network failed");
  EXPECT_THAT(
      RunLeaveOneSubjectOut(dataset, {"a"}, &method),
      StatusIs(absl::StatusCode::kUnavailable, HasSubstr("recorder: 0/0: the network failed")));
}

TEST(ProtocolTest, ErrorsOfSubjectsAndTrainingAreReturned) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  EXPECT_THAT(RunLeaveOneSubjectOut(dataset, {"z"}, &method),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("\"z\"")));
  method.status = absl::ResourceExhaustedError("too much");
  EXPECT_THAT(RunLeaveOneSubjectOut(dataset, {}, &method),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("too much")));
  dataset::Dataset nobody = dataset;
  for (dataset::Sequence& sequence : nobody.sequences) sequence.subjects.clear();
  EXPECT_THAT(RunLeaveOneSubjectOut(nobody, {}, &method),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("no subjects")));
}

}  // namespace
}  // namespace duet::evaluation::protocol
