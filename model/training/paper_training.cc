#include "model/training/paper_training.h"

#include "model/training/setting_fields.h"

namespace duet::training {

void Declare(SettingFields* fields, PaperTraining* paper) {
  fields->Section("dropout", [&] {
    fields->Number("slices", 0, 0.95, &paper->dropout.slices);
    fields->Number("encoded", 0, 0.95, &paper->dropout.encoded);
  });
  fields->Section("losses", [&, &l = paper->losses] {
    fields->Word("reconstruction", {"l1", "l2", "norm"}, &l.reconstruction);
    fields->Number("reconstruction_weight", 0, kMaxWeight, &l.reconstruction_weight);
    fields->Number("bone", 0, kMaxWeight, &l.bone);
    fields->Number("continuity", 0, kMaxWeight, &l.continuity);
    fields->Word("continuity_form", {"hinge", "path_length"}, &l.continuity_form);
    fields->Int("continuity_gap", 2, 64, &l.continuity_gap);
    fields->Number("continuity_margin", 0, 1e3, &l.continuity_margin);
    fields->Number("adversarial", 0, kMaxWeight, &l.adversarial);
  });
  fields->Section("discriminator", [&, &d = paper->discriminator] {
    fields->Bool("binary", &d.binary);
    fields->Int("hidden", 1, kMaxUnits, &d.hidden);
    fields->Number("learning_rate", 1e-9, 10, &d.learning_rate);
    fields->Number("dropout", 0, 0.95, &d.dropout);
    fields->Bool("unit_norm_kernels", &d.unit_norm_kernels);
  });
  fields->Share("graded_labels", &paper->graded_labels);
}

}  // namespace duet::training
