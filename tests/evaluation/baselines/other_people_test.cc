#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "model/evaluation/baselines/baselines.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::baselines {
namespace {

using test::MadeUpPairs;

constexpr auto kFirstFrame = motion::StandardOrigin::kFirstFrame;

// How a follower stands to its leader's first frame, wherever in the world that is.
Rows Seen(const dataset::Dataset& dataset, int index, const motion::Poses& follower) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
  return ToRows(metrics::StandardOf(dataset.skeleton, sequence, kFirstFrame).Apply(follower));
}

bool Alike(const Rows& a, const Rows& b) {
  return a.rows() == b.rows() && (a - b).cwiseAbs().maxCoeff() < 1e-4;
}

std::vector<int> OfClass(const dataset::Dataset& dataset, int interaction_class) {
  std::vector<int> found;
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    if (dataset.sequences[i].interaction_class == interaction_class) {
      found.push_back(static_cast<int>(i));
    }
  }
  return found;
}

// Which of `train` an answer to `asked` is the follower of, cut or stretched; -1: of none.
int Source(const dataset::Dataset& dataset, const std::vector<int>& train, int asked,
           const motion::Poses& answer) {
  for (const int index : train) {
    const motion::Poses& follower =
        dataset.sequences[static_cast<size_t>(index)].pair.follower.poses;
    const Rows answered = Seen(dataset, asked, answer), whole = Seen(dataset, index, follower);
    const Rows fitted = whole.rows() < answered.rows() ? StretchTo(whole, answered.rows())
                                                       : Rows(whole.topRows(answered.rows()));
    if (Alike(answered, fitted)) return index;
  }
  return -1;
}

TEST(OtherPeopleTest, AnswersAreCapturedFollowersOfTheClassWhereTheyStoodToTheirLeader) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  std::vector<int> train, test = {OfClass(dataset, 0)[0], OfClass(dataset, 1)[0]};
  for (int i = 0; i < static_cast<int>(dataset.sequences.size()); ++i) {
    if (std::count(test.begin(), test.end(), i) == 0) train.push_back(i);
  }
  std::vector<int> drawn;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto answers = AnswerWithOtherPeople(dataset, {train, test}, seed);
    ASSERT_TRUE(answers.ok());
    for (size_t i = 0; i < test.size(); ++i) {
      const int source = Source(dataset, train, test[i], (*answers)[i].follower);
      ASSERT_GE(source, 0);
      EXPECT_EQ(dataset.sequences[static_cast<size_t>(source)].interaction_class,
                dataset.sequences[static_cast<size_t>(test[i])].interaction_class);
      drawn.push_back(source);
    }
  }
  std::sort(drawn.begin(), drawn.end());
  drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
  EXPECT_GT(drawn.size(), 6);
}

TEST(OtherPeopleTest, LongerClipsAreCutAndShorterOnesStretchedWhereNoneIsLongEnough) {
  dataset::Dataset dataset = MadeUpPairs(3);
  const std::vector<int> same = OfClass(dataset, 0);
  auto& asked = dataset.sequences[static_cast<size_t>(same[0])].pair;
  auto& other = dataset.sequences[static_cast<size_t>(same[1])].pair;
  const motion::Clip whole = asked.leader;
  const int frames = whole.frame_count();
  asked.leader.poses.Resize(frames / 2);
  auto answers = AnswerWithOtherPeople(dataset, {{same[1]}, {same[0]}}, 0);
  ASSERT_TRUE(answers.ok());
  EXPECT_TRUE(Alike(Seen(dataset, same[0], answers->front().follower),
                    Seen(dataset, same[1], other.follower.poses).topRows(frames / 2)));
  asked.leader = whole;
  other.leader.poses.Resize(frames / 2);
  other.follower.poses.Resize(frames / 2);
  answers = AnswerWithOtherPeople(dataset, {{same[1]}, {same[0]}}, 0);
  ASSERT_TRUE(answers.ok());
  const Rows seen = Seen(dataset, same[0], answers->front().follower);
  ASSERT_EQ(seen.rows(), frames);
  EXPECT_TRUE(
      Alike(seen.bottomRows(1), Seen(dataset, same[1], other.follower.poses).bottomRows(1)));
}

}  // namespace
}  // namespace duet::evaluation::baselines
