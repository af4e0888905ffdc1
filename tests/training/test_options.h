#ifndef DUET_TESTS_TRAINING_TEST_OPTIONS_H_
#define DUET_TESTS_TRAINING_TEST_OPTIONS_H_

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"
#include "model/training/options.h"

namespace duet::training {

// Changes the settings that a text names: Change("own { share: 1 }", &options.flow).
inline void Change(const std::string& text, google::protobuf::Message* settings) {
  EXPECT_TRUE(google::protobuf::TextFormat::MergeFromString(text, settings)) << text;
}
template <typename Message>
Message Settings(const std::string& text) {
  Message settings;
  Change(text, &settings);
  return settings;
}

// Require options of the architecture.
inline checkpoint::PaperArchitecture& PaperOf(TrainingOptions* options) {
  return std::get<checkpoint::PaperArchitecture>(options->architecture);
}
inline checkpoint::FlowArchitecture& FlowOf(TrainingOptions* options) {
  return std::get<checkpoint::FlowArchitecture>(options->architecture);
}

// A network and a run small enough for a test, with every loss and every augmentation on.
inline TrainingOptions SmallOptions() {
  TrainingOptions options;
  checkpoint::PaperArchitecture& architecture = PaperOf(&options);
  architecture.follower_start = true;
  architecture.base_pose = true;
  architecture.slice_features = 4;
  architecture.encoder_hidden = 4;
  architecture.attention = 8;
  options.paper = Settings<PaperSettings>(R"(
      dropout { slices: 0.1 encoded: 0.1 }
      losses { bone: 0.01 continuity: 0.1 adversarial: 0.1 }
      discriminator { hidden: 4 learning_rate: 1e-3 }
      graded_labels: 0.5)");
  options.common = Settings<CommonSettings>(R"(
      optimiser { weight_decay: 0.01 gradient_clip: 1 average_decay: 0.5 }
      epochs: 4
      batch: 3
      seed: 5
      augmentation {
        mirror: 0.5 swap_roles: 0.5 body_scale: 0.05 time_warp: 0.1 yaw: 0.1 leader_yaw: 0.1
        noise: 0.01 body_noise: 0.01 crop: 0.5
      }
      start { root: 0.3 pose: 0.3 })");
  return options;
}

inline checkpoint::Manifest ManifestFor(const TrainingOptions& options,
                                        const dataset::Dataset& dataset) {
  checkpoint::Manifest manifest;
  manifest.model.name = dataset.name;
  manifest.model.version = 1;
  manifest.model.skeleton = dataset.skeleton;
  manifest.model.classes = dataset.classes;
  manifest.model.frame_rate_hz = dataset.frame_rate_hz;
  manifest.model.window_frames = dataset.LongestFrameCount();
  SetArchitecture(options.architecture, &manifest);
  manifest.parts = dataset.parts;
  manifest.standardisation = options.standardisation;
  return manifest;
}

}  // namespace duet::training

#endif  // DUET_TESTS_TRAINING_TEST_OPTIONS_H_
