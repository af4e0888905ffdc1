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

namespace duet::training {

// The settings of a run that trains the paper's generator (paper_trainer.h).
struct PaperTraining {
  checkpoint::PaperArchitecture architecture;

  struct Dropout {
    double slices = 0;   // after each slice's fully connected layer
    double encoded = 0;  // of the encoders' output h_t and of the decoder's state
  } dropout;

  struct Losses {
    double bone = 0;
    double continuity = 0;
    std::string continuity_form = "hinge";  // or "path_length"
    double adversarial = 0;                 // 0: no discriminator
  } losses;

  struct DiscriminatorSettings {
    bool binary = false;  // adds a second one that only separates real from synthesised (MSHL22)
    int64_t hidden = 0;
    double learning_rate = 0;
    double dropout = 0;
    bool unit_norm_kernels = false;
  } discriminator;

  // Fraction of clips trained on a graded, negative or mixed label vector (sampler.h).
  double graded_labels = 0;
};

// The settings of a run that trains the sampling generator (flow_trainer.h).
struct FlowTraining {
  checkpoint::FlowArchitecture architecture;

  double dropout = 0.1;
  int64_t passes = 10;          // over the data in an epoch, at least
  int64_t least_steps = 0;      // of a run; few clips get more passes until they reach it
  double window_seconds = 0;    // longer sequences are cut into windows; 0: never
  double stride_seconds = 0.5;  // between the beginnings of windows
  // The last seconds of a window, which the next window replaces when both belong to a longer clip:
  // their leader's future is unknown.
  double lookahead_seconds = 0;
  double target_smoothing = 1;    // frames, deviation of the Gaussian over captured followers
  double pair_scale = 0.1;        // +- fraction, the same for both people
  double unlabelled = 0.12;       // fraction of clips whose label is withheld
  double several_known = 0.4;     // of the clips with a start pose: up to half of the frames known
  double known_noise = 0.01;      // metres, deviation of each joint's error in known frames
  double difference_weight = 8;   // of differences of successive frames
  double bone_weight = 0;         // of limb lengths
  double slide_speed = 0.3;       // metres per second; a captured foot below it stands
  double least_remaining = 0.15;  // losses are divided by 1 - t, but at least by this
  double noise_share = 1;         // of the noise of training that the checkpoint's answers have
  // The power of the spread of its class by which a clip's loss is divided: 0 counts metres, 1
  // counts errors relative to how far the followers of the class move.
  double class_balance = 0;

  // Labels in training with frame_labels. By default every class of a frame has weight 1 and all
  // others 0.
  struct FrameLabels {
    double shift = 0;       // frames, standard deviation of the beginning and the end of a span
    double unlabelled = 0;  // fraction of the classes of a clip whose weight is 0 throughout
    double avoided = 0;     // fraction of the classes of a clip that have weight -1 where absent
  } frame_labels;

  // A follower that continues from its own previous answer does not start where a captured one
  // would. A fraction of the clips with a start pose therefore starts with an error and returns to
  // the captured motion. Standard deviations; 0 disables an error.
  struct Drift {
    double share = 0;     // of the clips with a start pose
    double tilt = 0;      // radians, of the whole body about a point on the floor
    double bend = 0;      // radians, of everything except the legs about the hips
    double turn = 0;      // radians, about the vertical
    double root = 0;      // metres along the floor
    double height = 0;    // metres
    double joints = 0;    // metres, of each joint independently
    int64_t frames = 20;  // from the last known frame until the captured motion is reached
  } drift;

  // Of a former kind of augmentation: 0. Configurations and saved states name it.
  struct Leaders {
    double share = 0;
  } leaders;

  // Clips in which nothing happens for a while, made from captured ones (stillness.h). Fractions of
  // the clips, which sum up to at most 1, unless said otherwise.
  struct Stillness {
    double pauses = 0;      // of the other clips: pauses before and after the reaction
    double ends = 0;        // the end of a reaction, and a longer rest
    double motionless = 0;  // the leader does not move
    double unlabelled = 0;  // the follower rests beside any leader, without a label
    double clean = 0;       // of all clips: the leader has no noise

    bool used() const { return pauses + ends + motionless + unlabelled > 0; }
  } stillness;

  // A fraction of the clips is trained as a live session answers them (flow_batches.h): the
  // leader's future is unknown.
  struct Live {
    double share = 0;             // of the clips
    double several_known = 0.8;   // of these: fraction with several known frames of the follower
    double remade_seconds = 0.4;  // from the last known frame to the present, at most
    double delay_seconds = 0.35;  // of the leader that is known after the present, at most
    double future_seconds = 1;    // of the window after the present
  } live;

  // Clips with several known frames may continue the network's own motion (flow_batches.h). Applies
  // to the last part of a run, described below.
  struct Own {
    double share = 0;            // of the clips with several known frames
    int64_t most_frames = 12;    // of the network's own, at most
    int64_t return_frames = 20;  // from the last known frame until the captured motion is reached
  } own;

  // The last part of a run trains whole answers, in the number of steps that sampling uses, by the
  // energy score: near the captured motion, and as varied as captured motions are.
  struct Energy {
    double from = 0.5;           // fraction of the epochs before it starts; 1: never
    int64_t answers = 2;         // drawn for each clip
    double velocity_weight = 1;  // of the score of velocities, frame by frame
    double block_weight = 1;     // of the score of velocities over several frames together
    int64_t block_frames = 6;
    double feet_weight = 0;    // of the score of which feet stand
    double hands_weight = 0;   // of the score of hands against the leader's hands
    double near_hands = 0.15;  // metres; what counts as near in that score
  } energy;

  // After the generator, a critic learns to tell its answers from captured followers
  // (finishing.h).
  struct Critic {
    int64_t steps = 0;    // 0: none
    int64_t answers = 8;  // drawn for each clip
  } critic;
};

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
    double mirror = 0;      // probability, of classes that are not handed
    double swap_roles = 0;  // probability, of symmetric classes
    double body_scale = 0;  // +- fraction, each person independently
    double time_warp = 0;   // +- log of the speed
    double yaw = 0;         // radians, standard deviation, of both people
    double leader_yaw = 0;  // radians, standard deviation, of the leader about its own root
    double noise = 0;       // metres, standard deviation, of the leader's joints in every frame
    double body_noise = 0;  // the same, one offset per joint for the whole clip
    double crop = 0;        // probability of a shorter part of the clip
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
  } validation;
};

// The settings of a sampling generator; null for another.
inline const FlowTraining* FlowIn(const TrainingOptions& options) {
  return std::get_if<FlowTraining>(&options.method);
}

// A configuration of model/training/configs, linked into the program.
struct NamedConfig {
  std::string_view name;
  std::string_view json;
};

const std::vector<NamedConfig>& NamedConfigs();

// The configuration of this name, or null.
const NamedConfig* FindConfig(std::string_view name);

// Parses a configuration, after replacing fields by dotted path: {"losses.bone", "0.01"}; values
// are JSON, or plain words. It has all settings, or the differences from a named configuration:
// {"base": "default", "set": {"losses.bone": 0}}. An unknown or missing field or a value out of
// range is INVALID_ARGUMENT naming the field, its value and the range.
absl::StatusOr<TrainingOptions> ParseConfig(
    std::string_view json,
    const std::vector<std::pair<std::string, std::string>>& replacements = {});

checkpoint::Architecture ArchitectureOf(const TrainingOptions& options);

// Every setting by dotted path, as a manifest stores it.
std::map<std::string, std::string> Describe(const TrainingOptions& options);

// Checks what depends on the data: held-out subjects must exist, and mirroring requires joint names
// that distinguish left and right.
absl::Status CheckAgainst(const TrainingOptions& options, const dataset::Dataset& dataset);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_OPTIONS_H_
