#ifndef DUET_CLIENT_CLI_SYNTHESIZE_ARGUMENTS_H_
#define DUET_CLIENT_CLI_SYNTHESIZE_ARGUMENTS_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/batch/recipe.h"
#include "client/cli/motion_arguments.h"
#include "client/cli/server_arguments.h"
#include "client/request.h"
#include "model/motion/beat.h"

namespace duet::client::cli {

// A keyframe as the user writes it: at a frame, or at a position in beats.
struct KeyframeArgument {
  int frame = 0;                // unless `beats` is set
  std::optional<double> beats;  // 0 is the first beat
  std::vector<ClassWeight> weights;
};

// The flags of duet synthesize.
struct SynthesizeArguments : SynthesisOptions {
  ServerArguments server;
  std::filesystem::path leader;
  formats::Side leader_side = kDefaultSide;
  InputArguments input;
  batch::Level level;
  ModelChoice model;
  std::vector<ClassWeight> weights;
  std::vector<KeyframeArgument> keyframes;
  std::optional<motion::Beat> beat;  // set if a keyframe has a position in beats
  std::string follower_start;        // empty, "X,Y,Z" or a motion file
  std::optional<formats::Side> follower_start_side;
  int samples = 1;  // answers, with the seeds `seed`, `seed` + 1, ...
  std::vector<std::filesystem::path> outputs;
  std::optional<OutputFormat> output_format;               // for standard output
  BvhArguments bvh;
  std::string follower_rig;  // empty, kLeadersRig or a file
  RigArguments rig;          // how to read that file; its `file` is not set
  bool json = false;
  bool quiet = false;
};
inline constexpr char kLeadersRig[] = "leader";

// The seed of a sample; the first sample is 0.
inline uint64_t SeedOf(const SynthesizeArguments& arguments, int sample) {
  return arguments.seed + static_cast<uint64_t>(sample);
}

// The output files of one sample. With several samples, pair.html becomes pair.seed7.html.
std::vector<std::filesystem::path> SampleOutputs(const SynthesizeArguments& arguments, int sample);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SYNTHESIZE_ARGUMENTS_H_
