#include "model/engine/unfamiliarity.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "gtest/gtest.h"
#include "model/engine/network_synthesizer.h"
#include "tests/engine/leader_motion.h"
#include "tests/engine/rule_network.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::engine {
namespace {

using test::FakeDescription;

constexpr int kWindow = 16;
constexpr double kNetworkRate = 15;

// Trained on people who stand.
ModelDescription TrainedOnStanding() {
  ModelDescription model = FakeDescription();
  model.skeleton = PlainSkeleton();
  model.frame_rate_hz = kNetworkRate;
  model.window_frames = kWindow;
  const motion::Poses standing = Standing(kWindow);
  model.leader_statistics = FitLeaderStatistics(model.skeleton, {&standing}, kNetworkRate);
  return model;
}

ClipRequest Request(motion::Poses leader, double frame_rate_hz = kNetworkRate) {
  return {std::move(leader), frame_rate_hz, LabelTrack(std::vector<float>(6, 0)),
          std::nullopt,      std::nullopt,  {}};
}

// Stands, but for `walked` windows of `windows`, in which the leader goes along x at 1 m/s.
motion::Poses WalkingIn(int walked, int windows) {
  const int frames = 1 + windows * (kWindow - 1), steps = walked * (kWindow - 1);
  motion::Poses leader = Standing(frames);
  for (int t = 0; t < frames; ++t) {
    for (motion::Vec3& joint : leader[t])
      joint.x += static_cast<float>(std::min(t, steps) / kNetworkRate);
  }
  return leader;
}

TEST(Unfamiliarity, IsNotKnownWithoutStatistics) {
  ModelDescription model = TrainedOnStanding();
  model.leader_statistics.reset();
  EXPECT_FALSE(Unfamiliarity(model, Request(Standing(kWindow))).has_value());
}

TEST(Unfamiliarity, OfOneWindowIsItsLeaders) {
  const ModelDescription model = TrainedOnStanding();
  EXPECT_NEAR(*Unfamiliarity(model, Request(Standing(kWindow))), 0, 1e-6);
  const motion::Poses walking = Walking(kWindow, 1 / kNetworkRate);
  const double far = Unfamiliarity(*model.leader_statistics, model.skeleton, walking, kNetworkRate);
  EXPECT_GT(far, 2);
  EXPECT_NEAR(*Unfamiliarity(model, Request(walking)), far, 1e-6);
}

TEST(Unfamiliarity, IsMeasuredAtTheModelsRate) {
  const ModelDescription model = TrainedOnStanding();
  const double far = *Unfamiliarity(model, Request(Walking(kWindow, 1 / kNetworkRate)));
  EXPECT_NEAR(*Unfamiliarity(
                  model, Request(Walking(2 * kWindow - 1, 0.5 / kNetworkRate), 2 * kNetworkRate)),
              far, 1e-3);
  // The same frames at twice the rate.
  EXPECT_GT(*Unfamiliarity(model, Request(Walking(kWindow, 1 / kNetworkRate), 2 * kNetworkRate)),
            far * 1.2);
}

TEST(Unfamiliarity, OfALongClipIsThatOfItsFarthestTenth) {
  const ModelDescription model = TrainedOnStanding();
  const double far = *Unfamiliarity(model, Request(WalkingIn(20, 20)));
  EXPECT_GT(far, 2);
  EXPECT_LT(*Unfamiliarity(model, Request(WalkingIn(1, 20))), 0.5);
  EXPECT_NEAR(*Unfamiliarity(model, Request(WalkingIn(4, 20))), far, 0.1 * far);
}

TEST(Unfamiliarity, IsNotKnownWhereNoNumberHoldsIt) {
  motion::Poses leader = Standing(kWindow);
  leader.at(3, 0).x = 3e38f;
  leader.at(4, 0).x = -3e38f;
  EXPECT_FALSE(Unfamiliarity(TrainedOnStanding(), Request(leader)).has_value());
}

TEST(Unfamiliarity, EverySynthesizerOfANetworkReportsIt) {
  const auto tells = [](const ModelDescription& model) {
    const auto synthesizer = MakeSynthesizer(
        model, motion::StandardOrigin::kFirstFrame,
        std::make_unique<RuleNetwork>([](Inputs) -> Answer { return absl::InternalError(""); }));
    return synthesizer->Unfamiliarity(Request(WalkingIn(2, 2)));
  };
  ModelDescription model = TrainedOnStanding();
  for (const bool samples : {false, true}) {
    model.samples = samples;
    EXPECT_EQ(tells(model), Unfamiliarity(model, Request(WalkingIn(2, 2))));
  }
  model.leader_statistics.reset();
  EXPECT_FALSE(tells(model).has_value());
}

}  // namespace
}  // namespace duet::engine
