#include "model/training/paper_training.h"

#include "model/training/setting_fields.h"

namespace duet::training {
namespace {

void Read(base::ObjectReader* reader, PaperTraining::Dropout* out) {
  out->slices = reader->Number("slices", 0, 0.95);
  out->encoded = reader->Number("encoded", 0, 0.95);
}

void Read(base::ObjectReader* reader, PaperTraining::Losses* out) {
  out->reconstruction = OneOf(reader, "reconstruction", {"l1", "l2", "norm"});
  out->reconstruction_weight = reader->Number("reconstruction_weight", 0, 1e6);
  out->bone = reader->Number("bone", 0, 1e6);
  out->continuity = reader->Number("continuity", 0, 1e6);
  out->continuity_form = OneOf(reader, "continuity_form", {"hinge", "path_length"});
  out->continuity_gap = reader->Int("continuity_gap", 2, 64);
  out->continuity_margin = reader->Number("continuity_margin", 0, 1e3);
  out->adversarial = reader->Number("adversarial", 0, 1e6);
}

void Read(base::ObjectReader* reader, PaperTraining::DiscriminatorSettings* out) {
  out->binary = reader->Bool("binary");
  out->hidden = reader->Int("hidden", 1, kMaxUnits);
  out->learning_rate = reader->Number("learning_rate", 1e-9, 10);
  out->dropout = reader->Number("dropout", 0, 0.95);
  out->unit_norm_kernels = reader->Bool("unit_norm_kernels");
}

}  // namespace

void ReadSections(base::ObjectReader* root, PaperTraining* out) {
  const auto section = [root](const char* name, auto* settings) {
    ReadSection(root, name, settings,
                [](base::ObjectReader* reader, auto* fields) { Read(reader, fields); });
  };
  section("dropout", &out->dropout);
  section("losses", &out->losses);
  section("discriminator", &out->discriminator);
  out->graded_labels = Probability(root, "graded_labels");
}

void Describe(const PaperTraining& o, Description* out) {
  out->insert({{"dropout.slices", Text(o.dropout.slices)},
               {"dropout.encoded", Text(o.dropout.encoded)},
               {"losses.reconstruction", o.losses.reconstruction},
               {"losses.reconstruction_weight", Text(o.losses.reconstruction_weight)},
               {"losses.bone", Text(o.losses.bone)},
               {"losses.continuity", Text(o.losses.continuity)},
               {"losses.continuity_form", o.losses.continuity_form},
               {"losses.continuity_gap", Text(o.losses.continuity_gap)},
               {"losses.continuity_margin", Text(o.losses.continuity_margin)},
               {"losses.adversarial", Text(o.losses.adversarial)},
               {"discriminator.binary", Text(o.discriminator.binary)},
               {"discriminator.hidden", Text(o.discriminator.hidden)},
               {"discriminator.learning_rate", Text(o.discriminator.learning_rate)},
               {"discriminator.dropout", Text(o.discriminator.dropout)},
               {"discriminator.unit_norm_kernels", Text(o.discriminator.unit_norm_kernels)},
               {"graded_labels", Text(o.graded_labels)}});
}

}  // namespace duet::training
