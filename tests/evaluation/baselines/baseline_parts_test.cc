// The pieces that the baselines are made of, against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/baselines/baselines.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::baselines {
namespace {

using test::MadeUpPairs;

// Every path of three frames through two states, weighed one by one.
struct Enumerated {
  double sum = 0;
  Rows states = Rows::Zero(3, 2);
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(2, 2);
};

Enumerated Enumerate(const ChainWeights& chain, const Rows& log_arrivals) {
  Enumerated all;
  for (int code = 0; code < 8; ++code) {
    const int s[] = {code & 1, (code >> 1) & 1, (code >> 2) & 1};
    double weight = chain.start(s[0]);
    for (int t = 0; t < 3; ++t) weight *= std::exp(log_arrivals(t, s[t]));
    for (int t = 1; t < 3; ++t) weight *= chain.step(s[t - 1], s[t]);
    all.sum += weight;
    for (int t = 0; t < 3; ++t) all.states(t, s[t]) += weight;
    for (int t = 1; t < 3; ++t) all.steps(s[t - 1], s[t]) += weight;
  }
  all.states /= all.sum;
  all.steps /= all.sum;
  return all;
}

TEST(ChainTest, AgreesWithEnumeration) {
  ChainWeights chain;
  chain.start = Eigen::RowVector2d(0.3, 2.0);
  chain.step = (Eigen::Matrix2d() << 0.9, 0.4, 0.2, 1.5).finished();
  Rows log_arrivals(3, 2);
  log_arrivals << 0.5, -1, -700, -702, 2, 0.3;
  const Enumerated all = Enumerate(chain, log_arrivals);
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(2, 2);
  const PathPosterior posterior = SumOverPaths(chain, log_arrivals, &steps);
  EXPECT_NEAR(posterior.log_sum, std::log(all.sum), 1e-9);
  EXPECT_LT((posterior.states - all.states).norm(), 1e-12);
  EXPECT_LT((steps - all.steps).norm(), 1e-12);
}

TEST(KMeansTest, FindsSeparateClusters) {
  Rows rows(6, 2);
  rows << 0, 0, 0, 1, 10, 10, 10, 11, -9, 5, -9, 6;
  Rows centres = KMeans(rows, 3, 1);
  ASSERT_EQ(centres.rows(), 3);
  std::vector<double> xs = {centres(0, 0), centres(1, 0), centres(2, 0)};
  EXPECT_THAT(xs, testing::UnorderedElementsAre(0, 10, -9));
  const std::vector<int> nearest = NearestCentres(centres, rows);
  EXPECT_EQ(nearest[0], nearest[1]);
  EXPECT_EQ(nearest[2], nearest[3]);
  EXPECT_NE(nearest[0], nearest[2]);
}

TEST(PoseSpaceTest, KeepsWhatTheComponentsSpan) {
  // Rows in a plane of three dimensions.
  Rows rows(5, 3);
  rows << 1, 2, 5, 2, 1, 5, 3, 3, 5, -1, 0, 5, 0, 4, 5;
  const PoseSpace plane(rows, 3);
  EXPECT_EQ(plane.dimensions(), 2);
  EXPECT_LT((plane.Reconstruct(plane.Project(rows)) - rows).norm(), 1e-9);
  const PoseSpace line(rows, 1);
  EXPECT_EQ(line.dimensions(), 1);
  EXPECT_GT((line.Reconstruct(line.Project(rows)) - rows).norm(), 0.1);
}

TEST(StretchToTest, KeepsBothEnds) {
  Rows motion(3, 1);
  motion << 0, 1, 4;
  const Rows longer = StretchTo(motion, 5);
  EXPECT_THAT(std::vector<double>(longer.data(), longer.data() + 5), ElementsAre(0, .5, 1, 2.5, 4));
  const Rows shorter = StretchTo(motion, 2);
  EXPECT_THAT(std::vector<double>(shorter.data(), shorter.data() + 2), ElementsAre(0, 4));
  EXPECT_EQ(StretchTo(motion.topRows(1), 3).rows(), 3);
}

TEST(MotionMatrixTest, TheStandardFrameIsTheSameWhereverThePairStands) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  // Sequences 0 and 5 differ in place and yaw alone at their first frames.
  const StandardPair a = StandardiseSequence(dataset.skeleton, dataset.sequences[0]);
  const StandardPair b = StandardiseSequence(dataset.skeleton, dataset.sequences[5]);
  EXPECT_LT((a.leader.row(0) - b.leader.row(0)).norm(), 1e-4);
  EXPECT_LT((a.follower.row(0) - b.follower.row(0)).norm(), 1e-4);
  // The follower stands in front, at -z.
  const Eigen::Index root = 3 * dataset.skeleton.root;
  EXPECT_NEAR(a.follower(0, root + 2), -1.2, 1e-4);
  EXPECT_NEAR(a.follower(0, root), 0, 1e-4);
}

TEST(MotionMatrixTest, StandardisationIsInvertible) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  const dataset::Sequence& sequence = dataset.sequences[2];
  const StandardPair pair = StandardiseSequence(dataset.skeleton, sequence);
  const motion::Poses world =
      metrics::StandardOf(dataset.skeleton, sequence, motion::StandardOrigin::kEveryFrame)
          .Invert(FromRows(pair.follower));
  ASSERT_EQ(world.frame_count(), sequence.pair.follower.frame_count());
  for (int t = 0; t < world.frame_count(); ++t) {
    for (int j = 0; j < world.joint_count(); ++j) {
      EXPECT_LT(Distance(world.at(t, j), sequence.pair.follower.at(t, j)), 1e-5);
    }
  }
}

TEST(MotionMatrixTest, CuesContainTheLeadersPath) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  dataset::Sequence sequence = dataset.sequences[0];
  const int joints = dataset.skeleton.joint_count();
  const StandardPair before = StandardLeader(dataset.skeleton, sequence);
  for (size_t i = 0; i < sequence.pair.leader.poses.all().size(); ++i) {
    sequence.pair.leader.poses.all()[i].y += 0.01f * static_cast<float>(i / 15);
  }
  const StandardPair after = StandardLeader(dataset.skeleton, sequence);
  const Eigen::Index way = 2 * 3 * joints, last = after.cues.rows() - 1;
  EXPECT_NEAR(before.cues(last, way + 1), 0, 1e-6);
  EXPECT_NEAR(after.cues(last, way + 1), 2 * 0.01 * static_cast<double>(last), 1e-5);
  EXPECT_NEAR(after.cues(last, way + 3), 1, 1e-9);  // the end of the time
  EXPECT_LT((before.leader - after.leader).norm(), 1e-4);
}

}  // namespace
}  // namespace duet::evaluation::baselines
