#include "model/training/flow_training.h"

#include "model/training/setting_fields.h"

namespace duet::training {
namespace {

constexpr int64_t kMostSteps = 100000000;

void Read(base::ObjectReader* reader, FlowTraining* out) {
  out->dropout = reader->Number("dropout", 0, 0.95);
  out->passes = reader->Int("passes", 1, kMaxEpochs);
  out->least_steps = reader->Int("least_steps", 0, kMostSteps);
  out->window_seconds = reader->Number("window_seconds", 0, 60);
  out->stride_seconds = reader->Number("stride_seconds", 0.01, 60);
  out->lookahead_seconds = reader->Number("lookahead_seconds", 0, 60);
  out->target_smoothing = reader->Number("target_smoothing", 0, 100);
  out->pair_scale = reader->Number("pair_scale", 0, 0.9);
  out->unlabelled = Probability(reader, "unlabelled");
  out->several_known = Probability(reader, "several_known");
  out->known_noise = reader->Number("known_noise", 0, 10);
  out->difference_weight = reader->Number("difference_weight", 0, 1e6);
  out->bone_weight = reader->Number("bone_weight", 0, 1e6);
  out->slide_weight = reader->Number("slide_weight", 0, 1e6);
  out->slide_speed = reader->Number("slide_speed", 0, 100);
  out->least_remaining = reader->Number("least_remaining", 1e-6, 1);
  out->noise_share = reader->Number("noise_share", 0, 2);
  // Optional: configurations of earlier versions do not have it.
  if (reader->Has("kept_share")) out->kept_share = Probability(reader, "kept_share");
}

void Read(base::ObjectReader* reader, FlowTraining::FrameLabels* out) {
  out->shift = reader->Number("shift", 0, 1000);
  out->unlabelled = Probability(reader, "unlabelled");
  out->avoided = Probability(reader, "avoided");
}

void Read(base::ObjectReader* reader, FlowTraining::Drift* out) {
  out->share = Probability(reader, "share");
  out->tilt = reader->Number("tilt", 0, 4);
  out->bend = reader->Number("bend", 0, 4);
  out->turn = reader->Number("turn", 0, 4);
  // Optional: configurations of version 1.0 do not have it.
  if (reader->Has("twist")) out->twist = reader->Number("twist", 0, 4);
  out->root = reader->Number("root", 0, 10);
  out->height = reader->Number("height", 0, 10);
  out->joints = reader->Number("joints", 0, 10);
  out->frames = reader->Int("frames", 1, 1000);
}

void Read(base::ObjectReader* reader, FlowTraining::Leaders* out) {
  out->share = Probability(reader, "share");
}

void Read(base::ObjectReader* reader, FlowTraining::Stillness* out) {
  out->pauses = Probability(reader, "pauses");
  out->ends = Probability(reader, "ends");
  out->motionless = Probability(reader, "motionless");
  out->unlabelled = Probability(reader, "unlabelled");
  out->clean = Probability(reader, "clean");
}

void Read(base::ObjectReader* reader, FlowTraining::Live* out) {
  out->share = Probability(reader, "share");
  out->several_known = Probability(reader, "several_known");
  out->remade_seconds = reader->Number("remade_seconds", 0, 60);
  out->delay_seconds = reader->Number("delay_seconds", 0, 60);
  out->future_seconds = reader->Number("future_seconds", 0.1, 60);
}

void Read(base::ObjectReader* reader, FlowTraining::Own* out) {
  out->share = Probability(reader, "share");
  out->most_frames = reader->Int("most_frames", 1, 1000);
  out->return_frames = reader->Int("return_frames", 1, 1000);
}

void Read(base::ObjectReader* reader, FlowTraining::Energy* out) {
  out->from = Probability(reader, "from");
  out->answers = reader->Int("answers", 2, 64);
  out->dropout = reader->Number("dropout", 0, 0.95);
  out->velocity_weight = reader->Number("velocity_weight", 0, 1e6);
  out->block_weight = reader->Number("block_weight", 0, 1e6);
  out->block_frames = reader->Int("block_frames", 2, 1000);
  out->bone_weight = reader->Number("bone_weight", 0, 1e6);
  out->feet_weight = reader->Number("feet_weight", 0, 1e6);
  out->hands_weight = reader->Number("hands_weight", 0, 1e6);
  out->near_hands = reader->Number("near_hands", 1e-3, 10);
}

void Read(base::ObjectReader* reader, FlowTraining::Critic* out) {
  out->steps = reader->Int("steps", 0, kMaxEpochs);
  out->answers = reader->Int("answers", 1, 64);
}

}  // namespace

void ReadSections(base::ObjectReader* root, FlowTraining* out) {
  const auto section = [root](const char* name, auto* settings) {
    ReadSection(root, name, settings,
                [](base::ObjectReader* reader, auto* fields) { Read(reader, fields); });
  };
  section("flow", out);
  section("frame_labels", &out->frame_labels);
  section("drift", &out->drift);
  section("live", &out->live);
  section("own", &out->own);
  section("energy", &out->energy);
  // Optional: configurations of earlier versions do not have them.
  if (root->Has("leaders")) section("leaders", &out->leaders);
  if (root->Has("stillness")) section("stillness", &out->stillness);
  if (root->Has("critic")) section("critic", &out->critic);
}

void Describe(const FlowTraining& f, Description* out) {
  out->insert({{"flow.dropout", Text(f.dropout)},
               {"flow.passes", Text(f.passes)},
               {"flow.least_steps", Text(f.least_steps)},
               {"flow.window_seconds", Text(f.window_seconds)},
               {"flow.stride_seconds", Text(f.stride_seconds)},
               {"flow.lookahead_seconds", Text(f.lookahead_seconds)},
               {"flow.target_smoothing", Text(f.target_smoothing)},
               {"flow.pair_scale", Text(f.pair_scale)},
               {"flow.unlabelled", Text(f.unlabelled)},
               {"flow.several_known", Text(f.several_known)},
               {"flow.known_noise", Text(f.known_noise)},
               {"flow.difference_weight", Text(f.difference_weight)},
               {"flow.bone_weight", Text(f.bone_weight)},
               {"flow.slide_weight", Text(f.slide_weight)},
               {"flow.slide_speed", Text(f.slide_speed)},
               {"flow.least_remaining", Text(f.least_remaining)},
               {"flow.noise_share", Text(f.noise_share)},
               {"flow.kept_share", Text(f.kept_share)},
               {"frame_labels.shift", Text(f.frame_labels.shift)},
               {"frame_labels.unlabelled", Text(f.frame_labels.unlabelled)},
               {"frame_labels.avoided", Text(f.frame_labels.avoided)},
               {"drift.share", Text(f.drift.share)},
               {"drift.tilt", Text(f.drift.tilt)},
               {"drift.bend", Text(f.drift.bend)},
               {"drift.turn", Text(f.drift.turn)},
               {"drift.twist", Text(f.drift.twist)},
               {"drift.root", Text(f.drift.root)},
               {"drift.height", Text(f.drift.height)},
               {"drift.joints", Text(f.drift.joints)},
               {"drift.frames", Text(f.drift.frames)},
               {"leaders.share", Text(f.leaders.share)},
               {"stillness.pauses", Text(f.stillness.pauses)},
               {"stillness.ends", Text(f.stillness.ends)},
               {"stillness.motionless", Text(f.stillness.motionless)},
               {"stillness.unlabelled", Text(f.stillness.unlabelled)},
               {"stillness.clean", Text(f.stillness.clean)},
               {"live.share", Text(f.live.share)},
               {"live.several_known", Text(f.live.several_known)},
               {"live.remade_seconds", Text(f.live.remade_seconds)},
               {"live.delay_seconds", Text(f.live.delay_seconds)},
               {"live.future_seconds", Text(f.live.future_seconds)},
               {"own.share", Text(f.own.share)},
               {"own.most_frames", Text(f.own.most_frames)},
               {"own.return_frames", Text(f.own.return_frames)},
               {"energy.from", Text(f.energy.from)},
               {"energy.answers", Text(f.energy.answers)},
               {"energy.dropout", Text(f.energy.dropout)},
               {"energy.velocity_weight", Text(f.energy.velocity_weight)},
               {"energy.block_weight", Text(f.energy.block_weight)},
               {"energy.block_frames", Text(f.energy.block_frames)},
               {"energy.bone_weight", Text(f.energy.bone_weight)},
               {"energy.feet_weight", Text(f.energy.feet_weight)},
               {"energy.hands_weight", Text(f.energy.hands_weight)},
               {"energy.near_hands", Text(f.energy.near_hands)},
               {"critic.steps", Text(f.critic.steps)},
               {"critic.answers", Text(f.critic.answers)}});
}

}  // namespace duet::training
