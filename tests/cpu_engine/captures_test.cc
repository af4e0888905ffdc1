// The effect of rounded weights with real leaders: on the answers, and on their distance from the
// captured followers.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/dataset/dataset.h"
#include "tests/support/data_folder.h"
#include "tests/support/matchers.h"

namespace duet::cpu_engine {
namespace {

using engine::SynthesisWindow;
using engine::Synthesizer;
using kernels::Precision;

// The first window of a capture.
SynthesisWindow WindowOf(const dataset::Sequence& sequence, const engine::ModelDescription& model,
                         bool tell_pose, bool clean_up) {
  const motion::Poses &leader = sequence.pair.leader.poses,
                      &follower = sequence.pair.follower.poses;
  const int frames = std::min(leader.frame_count(), model.window_frames);
  SynthesisWindow window;
  window.leader = motion::Poses(leader.joint_count(),
                                {leader.frames(0, frames).begin(), leader.frames(0, frames).end()});
  for (int t = 0; t < frames; ++t) {
    for (int c = 0; c < model.class_count(); ++c) {
      window.labels.push_back(c == sequence.interaction_class ? 1.0f : 0.0f);
    }
  }
  window.partner_direction = sequence.partner_direction;
  if (!clean_up) window.options.clean_up = false;
  if (tell_pose) {
    window.start = engine::FollowerStart{follower.at(0, model.skeleton.root),
                                         {follower[0].begin(), follower[0].end()}};
  }
  return window;
}

// The differences in all answers of a model.
struct Change {
  float farthest = 0;                 // maximum difference of a joint, metres
  double error = 0, exact_error = 0;  // mean distance from the captured follower, metres

  double RelativeError() const { return std::abs(error / exact_error - 1); }
};

Change ChangeByRounding(const Synthesizer& exact, const Synthesizer& rounded,
                        const dataset::Dataset& data, bool clean_up) {
  Change change;
  for (const dataset::Sequence& sequence : data.sequences) {
    for (const bool tell_pose : {false, true}) {
      const SynthesisWindow window = WindowOf(sequence, exact.description(), tell_pose, clean_up);
      const SynthesisWindow* const one = &window;
      const auto a = exact.Synthesize({&one, 1}).front(), b = rounded.Synthesize({&one, 1}).front();
      EXPECT_THAT(a, IsOk());
      EXPECT_THAT(b, IsOk());
      if (!a.ok() || !b.ok()) continue;
      for (std::size_t i = 0; i < a->all().size(); ++i) {
        const motion::Vec3 captured = sequence.pair.follower.poses.all()[i];
        change.farthest = std::max(change.farthest, Distance(a->all()[i], b->all()[i]));
        change.exact_error += Distance(a->all()[i], captured);
        change.error += Distance(b->all()[i], captured);
      }
    }
  }
  return change;
}

void ExpectLittleChange(const char* folder, const std::string& name, bool clean_up) {
  const auto path = test::FindData(folder);
  // Captures must not be distributed. parity_test.cc tests the same with a synthetic person.
  if (!path) GTEST_SKIP() << test::kNoData;
  const auto data = dataset::ReadDataset(*path);
  ASSERT_THAT(data, IsOk());
  const auto exact = LoadEmbeddedSynthesizers({true, Precision::kFloat32});
  const auto rounded = LoadEmbeddedSynthesizers({true, Precision::kInt16});
  ASSERT_THAT(exact, IsOk());
  ASSERT_THAT(rounded, IsOk());
  for (std::size_t i = 0; i < exact->size(); ++i) {
    const engine::ModelDescription& model = (*exact)[i]->description();
    if (model.name != name) continue;
    SCOPED_TRACE(absl::StrCat(model.name, " ", model.version));
    const Change change = ChangeByRounding(*(*exact)[i], *(*rounded)[i], *data, clean_up);
    EXPECT_LT(change.RelativeError(), 5e-3);
    // The clean-up makes decisions: whether a foot stands, to which side a body moves. A different
    // decision moves a joint by centimetres.
    if (!clean_up) {
      EXPECT_LT(change.farthest, model.samples ? 1e-3f : 2.5e-4f);
    }
  }
}

TEST(CapturesTest, RoundingChangesAnswersToSbuLittle) { ExpectLittleChange("sbu", "sbu", false); }
TEST(CapturesTest, RoundingChangesAnswersToK3hiLittle) {
  ExpectLittleChange("k3hi", "k3hi", false);
}
TEST(CapturesTest, RoundingChangesCleanedUpAnswersLittle) {
  ExpectLittleChange("sbu", "sbu", true);
}

}  // namespace
}  // namespace duet::cpu_engine
