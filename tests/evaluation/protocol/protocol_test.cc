#include "model/evaluation/protocol/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/status_matchers.h"

namespace duet::evaluation::protocol {
namespace {

using test::IsOk;
using test::MadeUpPairs;
using test::StatusIs;

using testing::ElementsAre;
using testing::HasSubstr;

// Answers with the leader moved, and writes down what it was given.
class Recorder : public Method {
 public:
  std::string name() const override { return "recorder"; }
  absl::Status Train(const dataset::Dataset&, const std::vector<int>& train) override {
    trained.push_back(train);
    return status;
  }
  std::vector<motion::Vec3> Predict(const dataset::Sequence& sequence) const override {
    follower_sizes.push_back(sequence.pair.follower.positions.size());
    std::vector<motion::Vec3> answer = sequence.pair.leader.positions;
    if (spoil) spoil(&answer);
    return answer;
  }
  bool reads_first_pose() const override { return told_first_pose; }

  bool told_first_pose = false;
  absl::Status status;
  std::function<void(std::vector<motion::Vec3>*)> spoil;
  std::vector<std::vector<int>> trained;
  mutable std::vector<size_t> follower_sizes;
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
  EXPECT_EQ(PoolMotions(*folds).size(), 6u);
}

TEST(ProtocolTest, HidesTheAnswer) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  ASSERT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method), IsOk());
  EXPECT_THAT(method.follower_sizes, ElementsAre(0, 0));
  method.told_first_pose = true;
  method.follower_sizes.clear();
  ASSERT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method), IsOk());
  EXPECT_THAT(method.follower_sizes, ElementsAre(15, 15));
}

TEST(ProtocolTest, RefusesWrongAnswersByName) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  Recorder method;
  method.spoil = [](std::vector<motion::Vec3>* answer) { answer->pop_back(); };
  EXPECT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("recorder: 0/0: 239 positions")));
  method.spoil = [](std::vector<motion::Vec3>* answer) { answer->back().y = std::nanf(""); };
  EXPECT_THAT(RunLeaveOneSubjectOut(dataset, {"a"}, &method),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("not finite")));
}

TEST(ProtocolTest, PassesErrorsOn) {
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
