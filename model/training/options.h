#ifndef DUET_MODEL_TRAINING_OPTIONS_H_
#define DUET_MODEL_TRAINING_OPTIONS_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"

namespace duet::training {

// Everything that shapes a training run; the named configurations are in model/training/configs.
struct TrainingOptions {
  checkpoint::GeneratorArchitecture generator;  // its parts come from the data set
  motion::StandardOrigin standardisation = motion::StandardOrigin::kEveryFrame;

  struct Dropout {
    double slices = 0;   // after each slice's fully connected layer
    double encoded = 0;  // of the encoders' output h_t and of the decoder's state
  } dropout;

  struct Optimiser {
    std::string name = "adam";  // "adam" (decoupled weight decay) or "rmsprop"
    double learning_rate = 2e-3;
    std::string schedule = "one_cycle";  // or "constant", or "cosine", which the next three are of
    int64_t warm_up_steps = 100;         // of a rate that rises from 0
    double last_share = 0.02;            // of the rate, at the end
    double second_moment = 0.999;        // decay of Adam's second moment
    double weight_decay = 0;             // of matrices alone
    double gradient_clip = 0;            // largest norm; 0: not clipped
    double average_decay = 0;            // exponential average of the weights; 0: none
  } optimiser;

  int64_t epochs = 40;
  int64_t batch = 32;
  uint64_t seed = 0;

  struct Losses {
    std::string reconstruction = "l1";  // "l1", "l2" or "norm"
    double reconstruction_weight = 1;
    double bone = 0;
    double continuity = 0;
    std::string continuity_form = "hinge";  // or "path_length"
    int64_t continuity_gap = 2;
    double continuity_margin = 0.1;
    double adversarial = 0;  // 0: no discriminator
  } losses;

  struct DiscriminatorSettings {
    bool binary = false;  // a second one beside it that tells real from synthesised alone (MSHL22)
    int64_t hidden = 200;
    double learning_rate = 1e-3;
    double dropout = 0;
    bool unit_norm_kernels = false;
  } discriminator;

  struct Augmentation {
    double mirror = 0;         // probability, of classes that are not handed
    double mirror_handed = 0;  // probability, of handed classes
    double swap_roles = 0;     // probability, of symmetric classes
    double body_scale = 0;     // +- share, each person alone
    double time_warp = 0;      // +- log of the speed
    double root_distance = 0;  // metres, standard deviation
    double yaw = 0;            // radians, standard deviation, of both people
    double leader_yaw = 0;     // radians, standard deviation, of the leader about its own root
    double noise = 0;          // metres, standard deviation, of the leader's joints in every frame
    double body_noise = 0;     // the same, one offset a joint for the whole clip
    double crop = 0;           // probability of a shorter piece
  } augmentation;

  // Share of clips trained on a graded, negative or mixed label vector (graded_labels.h).
  double graded_labels = 0;

  // Trains the sampling generator in place of the paper's: of the other settings it reads
  // standardisation, optimiser, epochs, batch, seed, augmentation, start and validation.
  struct Flow {
    checkpoint::FlowArchitecture generator;
    double dropout = 0.1;
    int64_t passes = 10;            // over the data in an epoch
    double target_smoothing = 1;    // frames, deviation of the Gaussian over captured followers
    double pair_scale = 0.1;        // +- share, both people alike
    double unlabelled = 0.12;       // share of clips whose label is withheld
    double several_known = 0.4;     // of the clips told a pose: told up to half of their frames
    double known_noise = 0.01;      // metres, deviation of each joint's error in what is told
    double difference_weight = 8;   // of what moves from frame to frame
    double bone_weight = 0;         // of limb lengths
    double slide_weight = 0;        // of feet that move where the captured ones stand
    double slide_speed = 0.3;       // metres a second, below which a captured foot stands
    double least_remaining = 0.15;  // losses are divided by 1 - t, or by this

    // A follower that goes on from its own last answer does not stand where a captured one would: a
    // share of the clips that are told a pose begins off it and finds back to what was captured.
    // Standard deviations; 0 for what does not happen.
    struct Drift {
      double share = 0;     // of the clips told a pose
      double tilt = 0;      // radians, of the whole body about a point on the floor
      double bend = 0;      // radians, of all but the legs about the hips
      double turn = 0;      // radians, about the vertical
      double root = 0;      // metres along the floor
      double height = 0;    // metres
      double joints = 0;    // metres, of every joint alone
      int64_t frames = 20;  // from the last told frame until it is found back
    } drift;

    // The last part of a run trains whole answers, in as many steps as they are sampled in, by the
    // energy score: near what was captured, and as far from one another as captured answers are.
    struct Energy {
      double from = 0.5;    // share of the epochs before it begins; 1: never
      int64_t answers = 2;  // drawn for each clip
      double dropout = 0;   // in place of the flow's: what it adds to the spread of the answers
                            // in training is missing afterwards
      double velocity_weight = 1;  // of the score of velocities, frame by frame
      double block_weight = 1;     // of the score of velocities over several frames together
      int64_t block_frames = 6;
    } energy;
  };
  std::optional<Flow> flow;

  // What a clip's follower start tells, by probability; the rest has none.
  struct Start {
    double root = 0;
    double pose = 0;
  } start;

  // What is held back from training to judge it: whole subjects, a share of the rest, or both.
  struct Validation {
    std::vector<std::string> subjects;  // every sequence that they are in
    double fraction = 0;                // of the remaining sequences, by class
    int64_t patience = 0;  // epochs without a better error before the run stops; 0: never stops
  } validation;
};

// Parses a configuration. Strict: every field is required, unknown ones are refused, and
// INVALID_ARGUMENT names the field, what came and what was wanted.
absl::StatusOr<TrainingOptions> ParseTrainingOptions(std::string_view json);

// The same after replacing fields by dotted path: {"losses.bone", "0.01"}; values are JSON, or
// plain words.
absl::StatusOr<TrainingOptions> ParseTrainingOptions(
    std::string_view json, const std::vector<std::pair<std::string, std::string>>& replacements);

// Every setting by dotted path, as a manifest keeps it.
std::map<std::string, std::string> Describe(const TrainingOptions& options);

// Checks what depends on the data: that held-back subjects exist, and that a skeleton that is to be
// mirrored says in its joints' names which are left and right.
absl::Status CheckAgainst(const TrainingOptions& options, const dataset::Dataset& dataset);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_OPTIONS_H_
