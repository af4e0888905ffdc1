#ifndef DUET_MODEL_TRAINING_OPTIONS_H_
#define DUET_MODEL_TRAINING_OPTIONS_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/checkpoint/architecture.h"
#include "model/dataset/dataset.h"
#include "model/motion/standardise.h"
#include "model/training/flow_training.h"
#include "model/training/paper_training.h"

namespace duet::training {

// The architecture to train and the settings that only its trainer uses: one alternative for each
// checkpoint::Architecture.
using Method = std::variant<PaperTraining, FlowTraining>;

// All settings of a training run. The named configurations are in model/training/configs.
struct TrainingOptions {
  Method method;
  motion::StandardOrigin standardisation = motion::StandardOrigin::kEveryFrame;

  struct Optimiser {
    std::string name = "adam";  // "adam" (decoupled weight decay) or "rmsprop"
    double learning_rate = 2e-3;
    std::string schedule = "one_cycle";  // or "constant", or "cosine"
    int64_t warm_up_steps = 100;         // "cosine": steps in which the rate rises from 0
    double last_share = 0.02;            // "cosine": final rate, as a fraction of learning_rate
    double second_moment = 0.999;        // "cosine": decay of Adam's second moment
    double weight_decay = 0;             // of matrices only
    double gradient_clip = 0;            // maximum norm; 0: not clipped
    double average_decay = 0;            // exponential average of the weights; 0: none
  } optimiser;

  int64_t epochs = 0;
  int64_t batch = 32;
  uint64_t seed = 0;

  struct Augmentation {
    double mirror = 0;         // probability, of classes that are not handed
    double mirror_handed = 0;  // probability, of handed classes
    double swap_roles = 0;     // probability, of symmetric classes
    double body_scale = 0;     // +- fraction, each person independently
    double time_warp = 0;      // +- log of the speed
    double root_distance = 0;  // metres, standard deviation
    double yaw = 0;            // radians, standard deviation, of both people
    double leader_yaw = 0;     // radians, standard deviation, of the leader about its own root
    double noise = 0;          // metres, standard deviation, of the leader's joints in every frame
    double body_noise = 0;     // the same, one offset per joint for the whole clip
    double crop = 0;           // probability of a shorter part of the clip
  } augmentation;

  // Probabilities of the follower start of a clip; otherwise it has none.
  struct Start {
    double root = 0;  // only the root
    double pose = 0;
  } start;

  // The sequences held out from training for validation: whole subjects, a fraction of the rest, or
  // both.
  struct Validation {
    std::vector<std::string> subjects;  // all sequences of these people
    double fraction = 0;                // of the remaining sequences, by class
    int64_t patience = 0;  // epochs without improvement before the run stops; 0: never stops
  } validation;
};

// Parses a configuration. Every field is required; an unknown field or a value out of range is
// INVALID_ARGUMENT naming the field, its value and the range.
absl::StatusOr<TrainingOptions> ParseTrainingOptions(std::string_view json);

// The same after replacing fields by dotted path: {"losses.bone", "0.01"}. Values are JSON, or
// plain words.
absl::StatusOr<TrainingOptions> ParseTrainingOptions(
    std::string_view json, const std::vector<std::pair<std::string, std::string>>& replacements);

checkpoint::Architecture ArchitectureOf(const TrainingOptions& options);

// Every setting by dotted path, as a manifest stores it.
std::map<std::string, std::string> Describe(const TrainingOptions& options);

// Checks what depends on the data: held-out subjects must exist, and mirroring requires joint names
// that distinguish left and right.
absl::Status CheckAgainst(const TrainingOptions& options, const dataset::Dataset& dataset);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_OPTIONS_H_
