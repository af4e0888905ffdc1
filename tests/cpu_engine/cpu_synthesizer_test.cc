#include "model/cpu_engine/cpu_synthesizer.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::cpu_engine {
namespace {

using test::SwayingMotion;
using test::TinyCheckpoint;

constexpr int kPaper = 1, kSampling = 3;  // versions of sbu

std::shared_ptr<const engine::Synthesizer> EmbeddedModel(const std::string& name, int version) {
  auto all = LoadEmbeddedSynthesizers();
  EXPECT_THAT(all, IsOk());
  if (!all.ok()) return nullptr;
  for (std::unique_ptr<engine::Synthesizer>& model : *all) {
    if (model->description().name == name && model->description().version == version) {
      return std::move(model);
    }
  }
  return nullptr;
}

std::shared_ptr<const engine::Synthesizer> Embedded(int version = kPaper) {
  return EmbeddedModel("sbu", version);
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

motion::Poses RunOne(const engine::Synthesizer& model, const engine::SynthesisWindow& window) {
  engine::WindowResult result = SynthesizeAll(model, {window}).front();
  EXPECT_THAT(result, IsOk());
  return result.ok() ? *result : motion::Poses();
}

float LargestDistance(const motion::Poses& a, const motion::Poses& b) {
  EXPECT_EQ(a.all().size(), b.all().size());
  float largest = 0;
  for (size_t i = 0; i < std::min(a.all().size(), b.all().size()); ++i) {
    largest = std::max(largest, Distance(a.all()[i], b.all()[i]));
  }
  return largest;
}

TEST(CpuSynthesizerTest, DefaultModelSamplesAndHasLeaderStatistics) {
  const auto all = LoadEmbeddedSynthesizers();
  ASSERT_THAT(all, IsOk());
  const engine::ModelDescription& model = all->front()->description();
  EXPECT_EQ(model.name, "sbu");
  EXPECT_TRUE(model.samples);
  EXPECT_TRUE(model.leader_statistics.has_value());
  EXPECT_TRUE(model.partner_direction.has_value());
}

TEST(CpuSynthesizerTest, AnswerDependsOnTheSeedUnlessVarietyIsZero) {
  const auto model = Embedded(kSampling);
  const auto answer = [&](uint64_t seed, float variety) {
    engine::SynthesisWindow window = MakeWindow(*model, 20);
    window.options.sampling = {seed, variety};
    return RunOne(*model, window);
  };
  EXPECT_EQ(answer(7, 1), answer(7, 1));
  EXPECT_GT(LargestDistance(answer(7, 1), answer(8, 1)), 0.02f);
  EXPECT_EQ(answer(7, 0), answer(8, 0));
}

TEST(CpuSynthesizerTest, EverydayAndSalsaAreFreeForAllUses) {
  const auto all = LoadEmbeddedSynthesizers();
  ASSERT_THAT(all, IsOk());
  std::vector<std::string> free;
  for (const std::unique_ptr<engine::Synthesizer>& model : *all) {
    const engine::ModelDescription& description = model->description();
    EXPECT_NE(description.terms, "") << description.name;
    if (!description.free_for_all_uses) continue;
    free.push_back(description.name);
    EXPECT_EQ(description.skeleton.joint_count(), 22) << description.name;
    EXPECT_EQ(description.frame_rate_hz, 30) << description.name;
    EXPECT_TRUE(description.samples) << description.name;
  }
  EXPECT_THAT(free, ::testing::ElementsAre("everyday", "salsa"));
}

TEST(CpuSynthesizerTest, BatchOfDifferentLengthsEqualsSingle) {
  for (const int version : {kPaper, kSampling}) {
    const auto model = Embedded(version);
    const std::vector<engine::SynthesisWindow> windows = {
        MakeWindow(*model, 2, 1), MakeWindow(*model, 45, 0), MakeWindow(*model, 17, 3)};
    const std::vector<engine::WindowResult> together = SynthesizeAll(*model, windows);
    for (size_t i = 0; i < windows.size(); ++i) {
      ASSERT_THAT(together[i], IsOk());
      EXPECT_LT(LargestDistance(*together[i], RunOne(*model, windows[i])), 1e-4f)
          << version << ", window " << i;
    }
  }
}

TEST(CpuSynthesizerTest, MovesAndTurnsWithTheLeader) {
  const auto model = Embedded();
  engine::SynthesisWindow window = MakeWindow(*model, 20);
  window.start = engine::FollowerStart{{0.3f, 1, 1}, {}};
  window.partner_direction = motion::Vec3{0.2f, 0, 1};
  const auto move = [](motion::Vec3 p) { return RotateY(p, 1.1) + motion::Vec3{3, 0.5f, -2}; };
  motion::Poses expected = RunOne(*model, window);
  for (motion::Vec3& p : expected.all()) p = move(p);
  for (motion::Vec3& p : window.leader.all()) p = move(p);
  window.start->root = move(window.start->root);
  window.partner_direction = RotateY(*window.partner_direction, 1.1);
  EXPECT_LT(LargestDistance(RunOne(*model, window), expected), 1e-4f);
}

TEST(CpuSynthesizerTest, FollowerStartsAtItsGivenStart) {
  const auto model = Embedded();
  engine::SynthesisWindow window = MakeWindow(*model, 30);
  const int root = model->description().skeleton.root;
  for (const motion::Vec3 offset : {motion::Vec3{0, 0, 0.9f}, motion::Vec3{1.2f, 0, 0}}) {
    window.start = engine::FollowerStart{window.leader.at(0, root) + offset, {}};
    const motion::Poses follower = RunOne(*model, window);
    EXPECT_LT(Distance(follower.at(0, root), window.start->root), 0.4f);
  }
}

TEST(CpuSynthesizerTest, NonFiniteResultFailsOnlyItsWindow) {
  checkpoint::Checkpoint checkpoint = TinyCheckpoint();
  for (checkpoint::Tensor& tensor : checkpoint.tensors) {
    for (float& value : tensor.values) value = 3e38f;  // finite, but the result is not
  }
  const auto model = MakeCpuSynthesizer(checkpoint);
  engine::SynthesisWindow window;
  window.leader = motion::Poses(4, checkpoint.manifest.model.skeleton.joint_count());
  float along = 0;
  for (motion::Vec3& position : window.leader.all()) {
    position = {along, std::fmod(along, 3.0f), 1};
    ++along;
  }
  window.labels.assign(4 * checkpoint.manifest.model.classes.size(), 1);
  const std::vector<engine::WindowResult> results = SynthesizeAll(*model, {window});
  EXPECT_THAT(results[0], StatusIs(absl::StatusCode::kInternal, HasSubstr("not finite")));
}

TEST(CpuSynthesizerTest, MissingFolderIsNamed) {
  EXPECT_THAT(LoadCpuSynthesizer("/nowhere/at/all"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("/nowhere/at/all")));
}

}  // namespace
}  // namespace duet::cpu_engine
