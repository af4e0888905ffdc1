#ifndef DUET_MODEL_ENGINE_SYNTHESIS_OPTIONS_H_
#define DUET_MODEL_ENGINE_SYNTHESIS_OPTIONS_H_

#include <cstdint>
#include <optional>

namespace duet::engine {

inline constexpr int kMostCandidates = 16, kDefaultCandidates = 1;
inline constexpr float kMostReaction = 2;

// Selects the sample that a sampling model draws. Models that do not sample
// (ModelDescription::samples) ignore it.
struct Sampling {
  // On the same engine, the same request with the same seed returns the same motion.
  uint64_t seed = 0;
  // In [0, 2]. 0: the typical motion; 1: as varied as the captured motion.
  float variety = 1;
  // Number of samples that are drawn for each window, in [1, kMostCandidates]; the best one is
  // returned (candidates.h).
  int candidates = kDefaultCandidates;
  // How much the leader's motion moves the follower, in [0, kMostReaction]: a factor of the
  // difference from the answer to a leader who stands still (mixture.h). Other values than 1 take
  // twice the evaluations.
  float reaction = 1;
  // Set for a window of an endless motion: the index of the window's first frame in it. The noise
  // of a frame is then the same in every window that contains the frame (frame_noise.h).
  std::optional<int64_t> first_frame = std::nullopt;
};

// What a caller chooses beyond leader, labels and start. The validator fills it in; ClipSynthesis
// copies it into every window. docs/guides/add_a_request_field.md describes how to add a field.
struct SynthesisOptions {
  Sampling sampling;
  // Whether to make a body of the follower (model/solver). Absent: the default of the server or of
  // the engine's pipeline.
  std::optional<bool> clean_up;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_SYNTHESIS_OPTIONS_H_
