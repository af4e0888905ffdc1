#ifndef DUET_TESTS_SUPPORT_FAKE_SYNTHESIZER_H_
#define DUET_TESTS_SUPPORT_FAKE_SYNTHESIZER_H_

#include <functional>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/vec3.h"

namespace duet::test {

// A model named "fake", version 1, of the SBU skeleton and classes: 15 Hz, windows of 46 frames.
engine::ModelDescription FakeDescription();

// The follower that a FakeSynthesizer answers with unless told otherwise: every leader position
// turned by half a turn about the world's y axis and moved by (0.25, 0, -1.5), plus the sum of the
// label weights in y. A test can compute what must come out, in any unit and at any length.
motion::Vec3 FakeAnswer(motion::Vec3 leader, absl::Span<const float> labels);

// FakeDescription of a model that samples, "fake_sampler".
engine::ModelDescription SamplingDescription();

// Where a FakeSynthesizer whose description says that it samples moves the answer to: variety times
// a length below 1 m in x that the seed tells. It goes on from settled frames by answering them.
motion::Vec3 FakeDraw(const engine::Sampling& sampling);

// A Synthesizer whose answer is known: the follower of a frame depends on that frame alone, and on
// the window's sampling and settled frames where it samples.
//
//   FakeSynthesizer fake;
//   fake.on_batch = [&](auto windows) { sizes.push_back(windows.size()); };
//
// Threads: as Synthesizer, as long as the hooks are and nobody replaces them meanwhile.
class FakeSynthesizer : public engine::Synthesizer {
 public:
  explicit FakeSynthesizer(engine::ModelDescription description = FakeDescription());

  const engine::ModelDescription& description() const override { return description_; }
  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const> windows) const override;

  std::optional<double> Unfamiliarity(const engine::ClipRequest& request) const override;

  // The follower's position for a leader's, and the frame's label vector.
  std::function<motion::Vec3(motion::Vec3, absl::Span<const float>)> answer = FakeAnswer;
  // Called at the start of every Synthesize: to record, or to block until the test says so.
  std::function<void(absl::Span<const engine::SynthesisWindow* const>)> on_batch;
  // A window for which this returns an error fails alone, with it.
  std::function<absl::Status(const engine::SynthesisWindow&)> window_status;
  // How far a request is from the training data; unknown unless told.
  std::function<double(const engine::ClipRequest&)> unfamiliarity;

 private:
  engine::WindowResult Answer(const engine::SynthesisWindow& window) const;
  static void Draw(const engine::SynthesisWindow& window, motion::Poses* follower);

  engine::ModelDescription description_;
};

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_FAKE_SYNTHESIZER_H_
