#ifndef DUET_MODEL_TRAINING_PAPER_TRAINING_H_
#define DUET_MODEL_TRAINING_PAPER_TRAINING_H_

#include <cstdint>
#include <string>

#include "model/checkpoint/paper_architecture.h"

namespace duet::training {

class SettingFields;

// The settings of a run that trains the paper's generator (paper_trainer.h).
struct PaperTraining {
  using Architecture = checkpoint::PaperArchitecture;
  static constexpr bool kFitsPartnerDirection = false;

  Architecture architecture;

  struct Dropout {
    double slices = 0;   // after each slice's fully connected layer
    double encoded = 0;  // of the encoders' output h_t and of the decoder's state
  } dropout;

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
    bool binary = false;  // adds a second one that only separates real from synthesised (MSHL22)
    int64_t hidden = 0;
    double learning_rate = 0;
    double dropout = 0;
    bool unit_norm_kernels = false;
  } discriminator;

  // Fraction of clips trained on a graded, negative or mixed label vector (graded_labels.h).
  double graded_labels = 0;
};

// Declares every setting except the architecture.
void Declare(SettingFields* fields, PaperTraining* paper);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_PAPER_TRAINING_H_
