#include "model/training/flow_training.h"

#include "model/training/setting_fields.h"

namespace duet::training {
namespace {

constexpr int64_t kMostSteps = 100000000;

void DeclareFlow(SettingFields* fields, FlowTraining* flow) {
  fields->Number("dropout", 0, 0.95, &flow->dropout);
  fields->Int("passes", 1, kMaxEpochs, &flow->passes);
  fields->Int("least_steps", 0, kMostSteps, &flow->least_steps);
  fields->Number("window_seconds", 0, 60, &flow->window_seconds);
  fields->Number("stride_seconds", 0.01, 60, &flow->stride_seconds);
  fields->Number("lookahead_seconds", 0, 60, &flow->lookahead_seconds);
  fields->Number("target_smoothing", 0, 100, &flow->target_smoothing);
  fields->Number("pair_scale", 0, 0.9, &flow->pair_scale);
  fields->Share("unlabelled", &flow->unlabelled);
  fields->Share("several_known", &flow->several_known);
  fields->Number("known_noise", 0, 10, &flow->known_noise);
  fields->Number("difference_weight", 0, kMaxWeight, &flow->difference_weight);
  fields->Number("bone_weight", 0, kMaxWeight, &flow->bone_weight);
  fields->Number("slide_weight", 0, kMaxWeight, &flow->slide_weight);
  fields->Number("slide_speed", 0, 100, &flow->slide_speed);
  fields->Number("least_remaining", 1e-6, 1, &flow->least_remaining);
  fields->Number("noise_share", 0, 2, &flow->noise_share);
  if (fields->Has("kept_share")) fields->Share("kept_share", &flow->kept_share);
}

void DeclareDrift(SettingFields* fields, FlowTraining::Drift* drift) {
  fields->Share("share", &drift->share);
  fields->Number("tilt", 0, 4, &drift->tilt);
  fields->Number("bend", 0, 4, &drift->bend);
  fields->Number("turn", 0, 4, &drift->turn);
  if (fields->Has("twist")) fields->Number("twist", 0, 4, &drift->twist);
  fields->Number("root", 0, 10, &drift->root);
  fields->Number("height", 0, 10, &drift->height);
  fields->Number("joints", 0, 10, &drift->joints);
  fields->Int("frames", 1, 1000, &drift->frames);
}

void DeclareLive(SettingFields* fields, FlowTraining::Live* live) {
  fields->Share("share", &live->share);
  fields->Share("several_known", &live->several_known);
  fields->Number("remade_seconds", 0, 60, &live->remade_seconds);
  fields->Number("delay_seconds", 0, 60, &live->delay_seconds);
  fields->Number("future_seconds", 0.1, 60, &live->future_seconds);
}

void DeclareEnergy(SettingFields* fields, FlowTraining::Energy* energy) {
  fields->Share("from", &energy->from);
  fields->Int("answers", 2, 64, &energy->answers);
  fields->Number("dropout", 0, 0.95, &energy->dropout);
  fields->Number("velocity_weight", 0, kMaxWeight, &energy->velocity_weight);
  fields->Number("block_weight", 0, kMaxWeight, &energy->block_weight);
  fields->Int("block_frames", 2, 1000, &energy->block_frames);
  fields->Number("bone_weight", 0, kMaxWeight, &energy->bone_weight);
  fields->Number("feet_weight", 0, kMaxWeight, &energy->feet_weight);
  fields->Number("hands_weight", 0, kMaxWeight, &energy->hands_weight);
  fields->Number("near_hands", 1e-3, 10, &energy->near_hands);
}

void DeclareStillness(SettingFields* fields, FlowTraining::Stillness* stillness) {
  fields->Share("pauses", &stillness->pauses);
  fields->Share("ends", &stillness->ends);
  fields->Share("motionless", &stillness->motionless);
  fields->Share("unlabelled", &stillness->unlabelled);
  fields->Share("clean", &stillness->clean);
}

}  // namespace

void Declare(SettingFields* fields, FlowTraining* flow) {
  fields->Section("flow", [&] { DeclareFlow(fields, flow); });
  fields->Section("frame_labels", [&, &labels = flow->frame_labels] {
    fields->Number("shift", 0, 1000, &labels.shift);
    fields->Share("unlabelled", &labels.unlabelled);
    fields->Share("avoided", &labels.avoided);
  });
  fields->Section("drift", [&] { DeclareDrift(fields, &flow->drift); });
  fields->Section("live", [&] { DeclareLive(fields, &flow->live); });
  fields->Section("own", [&, &own = flow->own] {
    fields->Share("share", &own.share);
    fields->Int("most_frames", 1, 1000, &own.most_frames);
    fields->Int("return_frames", 1, 1000, &own.return_frames);
  });
  fields->Section("energy", [&] { DeclareEnergy(fields, &flow->energy); });
  if (fields->Has("leaders")) {
    fields->Section("leaders", [&] { fields->Share("share", &flow->leaders.share); });
  }
  if (fields->Has("stillness")) {
    fields->Section("stillness", [&] { DeclareStillness(fields, &flow->stillness); });
  }
  if (fields->Has("critic")) {
    fields->Section("critic", [&, &critic = flow->critic] {
      fields->Int("steps", 0, kMaxEpochs, &critic.steps);
      fields->Int("answers", 1, 64, &critic.answers);
    });
  }
}

}  // namespace duet::training
