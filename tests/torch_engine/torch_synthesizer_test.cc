#include "model/torch_engine/torch_synthesizer.h"

#include <gmock/gmock.h>

#include <cmath>

#include "model/motion/limb_lengths.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::torch_engine {
namespace {

using test::IsOk;
using test::StatusIs;
using test::SwayingMotion;
using test::SwayingPose;
using test::TinyCheckpoint;

using ::testing::HasSubstr;

std::shared_ptr<const engine::Synthesizer> Embedded() {
  SetTorchThreads(1);
  auto all = LoadEmbeddedSynthesizers();
  EXPECT_THAT(all, IsOk());
  return all.ok() ? std::move(all->front()) : nullptr;
}

engine::SynthesisWindow MakeWindow(const engine::Synthesizer& model, int frames,
                                   int interaction_class = 0) {
  engine::SynthesisWindow window;
  window.leader = SwayingMotion(frames, model.description().frame_rate_hz);
  const size_t classes = model.description().classes.size();
  window.labels.assign(static_cast<size_t>(frames) * classes, 0);
  for (size_t t = 0; t < static_cast<size_t>(frames); ++t) {
    window.labels[t * classes + static_cast<size_t>(interaction_class)] = 1;
  }
  return window;
}

std::vector<engine::WindowResult> SynthesizeAll(
    const engine::Synthesizer& model, const std::vector<engine::SynthesisWindow>& windows) {
  std::vector<const engine::SynthesisWindow*> pointers;
  for (const engine::SynthesisWindow& window : windows) pointers.push_back(&window);
  return model.Synthesize(pointers);
}

std::vector<motion::Vec3> RunOne(const engine::Synthesizer& model,
                                 const engine::SynthesisWindow& window) {
  engine::WindowResult result = SynthesizeAll(model, {window}).front();
  EXPECT_THAT(result, IsOk());
  return result.ok() ? *result : std::vector<motion::Vec3>{};
}

float LargestDistance(const std::vector<motion::Vec3>& a, const std::vector<motion::Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  float largest = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    largest = std::max(largest, Distance(a[i], b[i]));
  }
  return largest;
}

TEST(TorchSynthesizerTest, EmbeddedModelIsTheSixClassesOfSbu) {
  const auto model = Embedded();
  EXPECT_THAT(
      model->description().classes,
      ::testing::ElementsAre("kick", "push", "shake_hands", "hug", "exchange_object", "punch"));
  EXPECT_EQ(model->description().skeleton.joint_names, motion::SbuSkeleton().joint_names);
  EXPECT_TRUE(model->description().accepts_follower_start);
}

TEST(TorchSynthesizerTest, K3hiIsEmbeddedBesideIt) {
  const auto all = LoadEmbeddedSynthesizers();
  ASSERT_THAT(all, IsOk());
  ASSERT_EQ(all->size(), 2u);
  const engine::ModelDescription& model = all->back()->description();
  EXPECT_EQ(model.name, "k3hi");
  EXPECT_EQ(model.frame_rate_hz, 30);
  EXPECT_THAT(model.classes, ::testing::ElementsAre("approach", "depart", "exchange_object", "kick",
                                                    "point", "punch", "push", "shake_hands"));
  EXPECT_EQ(RunOne(*all->back(), MakeWindow(*all->back(), 60, 4)).size(), 60u * 15);
}

TEST(TorchSynthesizerTest, BatchOfDifferentLengthsEqualsSingle) {
  const auto model = Embedded();
  const std::vector<engine::SynthesisWindow> windows = {
      MakeWindow(*model, 2, 1), MakeWindow(*model, 45, 0), MakeWindow(*model, 17, 3)};
  const std::vector<engine::WindowResult> together = SynthesizeAll(*model, windows);
  for (size_t i = 0; i < windows.size(); ++i) {
    ASSERT_THAT(together[i], IsOk());
    EXPECT_LT(LargestDistance(*together[i], RunOne(*model, windows[i])), 1e-5f) << i;
  }
}

TEST(TorchSynthesizerTest, MovesAndTurnsWithTheLeader) {
  const auto model = Embedded();
  engine::SynthesisWindow window = MakeWindow(*model, 20);
  window.start = engine::FollowerStart{{0.3f, 1, 1}, {}};
  window.partner_direction = motion::Vec3{0.2f, 0, 1};
  const auto move = [](motion::Vec3 p) { return RotateY(p, 1.1) + motion::Vec3{3, 0.5f, -2}; };
  std::vector<motion::Vec3> expected = RunOne(*model, window);
  for (motion::Vec3& p : expected) p = move(p);
  for (motion::Vec3& p : window.leader) p = move(p);
  window.start->root = move(window.start->root);
  window.partner_direction = RotateY(*window.partner_direction, 1.1);
  EXPECT_LT(LargestDistance(RunOne(*model, window), expected), 1e-4f);
}

TEST(TorchSynthesizerTest, FollowerStandsWhereItsStartSays) {
  const auto model = Embedded();
  engine::SynthesisWindow window = MakeWindow(*model, 30);
  const int root = model->description().skeleton.root;
  for (const motion::Vec3 offset : {motion::Vec3{0, 0, 0.9f}, motion::Vec3{1.2f, 0, 0}}) {
    window.start = engine::FollowerStart{window.leader[static_cast<size_t>(root)] + offset, {}};
    const std::vector<motion::Vec3> follower = RunOne(*model, window);
    EXPECT_LT(Distance(follower[static_cast<size_t>(root)], window.start->root), 0.4f);
  }
}

TEST(TorchSynthesizerTest, PartnerDirectionPlacesTheFollower) {
  const auto model = Embedded();
  engine::SynthesisWindow window = MakeWindow(*model, 30);
  const size_t root = static_cast<size_t>(model->description().skeleton.root);
  for (const motion::Vec3 direction :
       {motion::Vec3{1, 0, 0}, motion::Vec3{-1, 0, 0}, motion::Vec3{0, 0, 1}}) {
    window.partner_direction = direction;
    const motion::Vec3 across = RunOne(*model, window)[root] - window.leader[root];
    EXPECT_GT(Dot(across, direction) / Norm(across), 0.8f);
  }
}

TEST(TorchSynthesizerTest, LabelsChangeTheAnswer) {
  const auto model = Embedded();
  const std::vector<motion::Vec3> kick = RunOne(*model, MakeWindow(*model, 30, 0));
  const std::vector<motion::Vec3> hug = RunOne(*model, MakeWindow(*model, 30, 3));
  EXPECT_GT(LargestDistance(kick, hug), 0.2f);
}

TEST(TorchSynthesizerTest, LimbsKeepTheLengthsOfTheStartOrElseTheLeader) {
  const auto model = Embedded();
  const motion::Skeleton& skeleton = model->description().skeleton;
  engine::SynthesisWindow window = MakeWindow(*model, 30);
  const auto expect_lengths = [&](const std::vector<motion::Vec3>& owner) {
    const std::vector<motion::Vec3> follower = RunOne(*model, window);
    const std::vector<float> wanted = MedianBoneLengths(skeleton, owner);
    for (size_t t = 0; t < 30; ++t) {
      const auto pose = follower.begin() + static_cast<std::ptrdiff_t>(t * 15);
      const std::vector<float> lengths = MedianBoneLengths(skeleton, {pose, pose + 15});
      for (size_t b = 0; b < wanted.size(); ++b) EXPECT_NEAR(lengths[b], wanted[b], 1e-4f);
    }
  };
  expect_lengths(window.leader);
  std::vector<motion::Vec3> tall = SwayingPose(0);
  for (motion::Vec3& joint : tall) joint = joint * 1.1f + motion::Vec3{0, 0, -1};
  window.start = engine::FollowerStart{tall[static_cast<size_t>(skeleton.root)], tall};
  expect_lengths(tall);
}

TEST(TorchSynthesizerTest, FollowerWithoutAStartStandsOnTheLeadersFloor) {
  const auto model = Embedded();
  const motion::Skeleton& skeleton = model->description().skeleton;
  const engine::SynthesisWindow window = MakeWindow(*model, 30);
  const auto lowest = [&](const std::vector<motion::Vec3>& positions) {
    float y = 1e9f;
    for (size_t t = 0; t < positions.size(); t += 15) {
      y = std::min({y, positions[t + static_cast<size_t>(skeleton.left_foot)].y,
                    positions[t + static_cast<size_t>(skeleton.right_foot)].y});
    }
    return y;
  };
  EXPECT_NEAR(lowest(RunOne(*model, window)), lowest(window.leader), 1e-5f);
}

TEST(TorchSynthesizerTest, ResultThatIsNotFiniteFailsAlone) {
  checkpoint::Checkpoint checkpoint = TinyCheckpoint();
  for (checkpoint::Tensor& tensor : checkpoint.tensors) {
    for (float& value : tensor.values) value = 3e38f;  // finite, but not what comes of it
  }
  const auto model = MakeTorchSynthesizer(checkpoint);
  ASSERT_THAT(model, IsOk());
  const size_t joints = checkpoint.manifest.model.skeleton.joint_names.size();
  engine::SynthesisWindow window;
  for (size_t i = 0; i < 4 * joints; ++i) {
    window.leader.push_back({static_cast<float>(i), static_cast<float>(i % 3), 1});
  }
  window.labels.assign(4 * checkpoint.manifest.model.classes.size(), 1);
  const std::vector<engine::WindowResult> results = SynthesizeAll(**model, {window});
  EXPECT_THAT(results[0], StatusIs(absl::StatusCode::kInternal, HasSubstr("not finite")));
}

TEST(TorchSynthesizerTest, CheckpointOfOtherShapesIsRefused) {
  checkpoint::Checkpoint checkpoint = TinyCheckpoint();
  checkpoint.tensors[0].shape[0] += 1;
  EXPECT_THAT(MakeTorchSynthesizer(checkpoint),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(checkpoint.tensors[0].name)));
  EXPECT_THAT(LoadTorchSynthesizer("/nowhere/at/all"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("/nowhere/at/all")));
}

}  // namespace
}  // namespace duet::torch_engine
