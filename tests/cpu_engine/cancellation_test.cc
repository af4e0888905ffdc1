#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/embedded/embedded.h"

namespace duet::cpu_engine {
namespace {

constexpr std::atomic<bool> kCancelled{true}, kWanted{false};

// Six windows, more than are decoded together.
std::vector<engine::NetworkInput> Windows(const engine::ModelDescription& model) {
  std::vector<engine::NetworkInput> inputs(6);
  for (std::size_t n = 0; n < inputs.size(); ++n) {
    const int frames = 5 + static_cast<int>(n);
    inputs[n].leader = motion::Poses(frames, model.skeleton.joint_count());
    inputs[n].labels.assign(static_cast<std::size_t>(frames) * model.classes.size(), 0.5f);
    inputs[n].cancelled = &kWanted;
  }
  return inputs;
}

bool IsZero(const motion::Poses& poses) {
  return std::all_of(poses.all().begin(), poses.all().end(),
                     [](const motion::Vec3& p) { return p == motion::Vec3{}; });
}

class CancellationTest : public testing::TestWithParam<embedded::EmbeddedCheckpoint> {
 protected:
  CancellationTest()
      : checkpoint_(*checkpoint::ParseCheckpoint(GetParam().manifest, GetParam().weights)),
        network_(MakeCpuNetwork(checkpoint_, BestPrecision())),
        inputs_(Windows(checkpoint_.manifest.model)) {}

  const checkpoint::Checkpoint checkpoint_;
  const std::unique_ptr<const engine::Network> network_;
  std::vector<engine::NetworkInput> inputs_;
};

TEST_P(CancellationTest, CancelledWindowsAreNotComputed) {
  for (engine::NetworkInput& input : inputs_) input.cancelled = &kCancelled;
  const auto followers = network_->Run(inputs_);
  ASSERT_TRUE(followers.ok());
  ASSERT_EQ(followers->size(), inputs_.size());
  for (std::size_t n = 0; n < inputs_.size(); ++n) {
    EXPECT_EQ((*followers)[n].frame_count(), inputs_[n].leader.frame_count());
    EXPECT_TRUE(IsZero((*followers)[n])) << n;
  }
}

TEST_P(CancellationTest, OtherWindowsOfTheBatchDoNotChange) {
  const auto wanted = network_->Run(inputs_);
  ASSERT_TRUE(wanted.ok());
  for (const std::size_t n : {0, 1, 2, 3}) inputs_[n].cancelled = &kCancelled;
  const auto followers = network_->Run(inputs_);
  ASSERT_TRUE(followers.ok());
  for (const std::size_t n : {4, 5}) {
    EXPECT_FALSE(IsZero((*followers)[n]));
    EXPECT_TRUE((*followers)[n] == (*wanted)[n]) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Embedded, CancellationTest,
                         testing::ValuesIn(embedded::EmbeddedCheckpoints()),
                         [](const auto& of) { return std::to_string(of.index); });

}  // namespace
}  // namespace duet::cpu_engine
