#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <vector>

#include "absl/status/status.h"
#include "server/registry/model_repository.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::registry {
namespace {

using test::FakeSynthesizer;

TEST(GoldenLeaderTest, StandsOnTheFloorAndMoves) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const motion::Poses leader = GoldenLeader(skeleton, 30, 15);
  ASSERT_EQ(leader.frame_count(), 30);
  ASSERT_EQ(leader.joint_count(), skeleton.joint_count());
  float lowest = std::numeric_limits<float>::max();
  for (const motion::Vec3& position : leader.all()) {
    lowest = std::min(lowest, position.y);
    EXPECT_LT(position.y, 2);
    EXPECT_LT(std::abs(position.x), 1);
    EXPECT_LT(std::abs(position.z), 1);
  }
  EXPECT_EQ(lowest, 0);
  EXPECT_GT(leader.at(0, skeleton.root).y, 0.5);
  EXPECT_NE(leader.at(0, 0), leader.at(10, 0));
  const float hips =
      Distance(leader.at(0, skeleton.hips->left), leader.at(0, skeleton.hips->right));
  EXPECT_GT(hips, 0.1) << "the leader faces somewhere";
}

TEST(GoldenLeaderTest, NeedsNoLandmarks) {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"a", "b", "c"};
  skeleton.bones = {{0, 1}, {0, 2}};
  const motion::Poses leader = GoldenLeader(skeleton, 2, 30);
  std::set<float> heights;
  for (const motion::Vec3& position : leader[0]) {
    EXPECT_TRUE(IsFinite(position));
    EXPECT_GE(position.y, 0);
  }
}

TEST(CheckAnswersTest, AsksForNoClassAndForEachAlone) {
  FakeSynthesizer model;
  std::vector<std::vector<float>> labels;
  model.on_batch = [&](absl::Span<const engine::SynthesisWindow* const> windows) {
    for (const engine::SynthesisWindow* window : windows) {
      EXPECT_EQ(window->leader.frame_count(), 46);
      EXPECT_EQ(window->options.clean_up, false);
      labels.emplace_back(window->labels.begin(), window->labels.begin() + 6);
    }
  };
  EXPECT_THAT(CheckAnswers(model), IsOk());
  ASSERT_EQ(labels.size(), 7u);
  EXPECT_EQ(labels[0], std::vector<float>(6, 0));
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<float> alone(6, 0);
    alone[i] = 1;
    EXPECT_EQ(labels[i + 1], alone);
  }
}

TEST(CheckAnswersTest, RejectsFollowersThatAreFarAwayOrNotFinite) {
  for (const float x : {9.0f, -6e32f, std::numeric_limits<float>::infinity(),
                        std::numeric_limits<float>::quiet_NaN()}) {
    FakeSynthesizer model;
    // Of one class alone, and of its lowest joints.
    model.answer = [x](motion::Vec3 leader, absl::Span<const float> labels) {
      return labels[3] > 0 && leader.y < 0.1f ? motion::Vec3{x, 1, 0} : leader;
    };
    EXPECT_THAT(CheckAnswers(model),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("m in frame 0")))
        << x;
  }
}

}  // namespace
}  // namespace duet::server::registry
