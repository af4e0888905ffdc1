// duet-keyframe: converts a handwritten key-frame file to a BVH clip.
//
//   duet-keyframe samples/keyframes/kick.txt --out samples/kick.bvh

#include <cstddef>
#include <iostream>
#include <optional>
#include <string>

#include "CLI/CLI.hpp"
#include "absl/status/status.h"
#include "model/authoring/keyframes.h"
#include "model/base/file.h"
#include "model/base/program_flags.h"
#include "model/base/program_output.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/motion/skeleton.h"

namespace duet::authoring {
namespace {

constexpr std::size_t kMaxKeyframeBytes = std::size_t{16} << 20;

absl::Status Convert(const std::string& keyframes, const std::string& out) {
  const absl::StatusOr<std::string> text =
      base::ReadFile(keyframes, kMaxKeyframeBytes, "key frames");
  if (!text.ok()) return text.status();
  const absl::StatusOr<motion::Clip> clip = ParseKeyframes(*text, keyframes);
  if (!clip.ok()) return clip.status();
  const absl::StatusOr<formats::bvh::BvhDocument> document =
      formats::bvh::ToBvh(*clip, motion::SbuSkeleton());
  if (!document.ok()) return document.status();
  return base::WriteFile(out, FormatBvh(*document));
}

int Run(int argc, char** argv) {
  CLI::App app("Converts a handwritten key-frame file to a BVH clip.", "duet-keyframe");
  app.set_version_flag("--version", "duet-keyframe " DUET_VERSION);
  std::string keyframes, out;
  app.add_option("keyframes", keyframes, "Key-frame file (docs/formats.md)")->required();
  app.add_option("--out", out, "The BVH file to write")->required();
  if (const std::optional<int> code = base::ParseFlags(argc, argv, &app)) return *code;
  const absl::Status status = Convert(keyframes, out);
  if (status.ok()) return 0;
  std::cerr << "duet-keyframe: " << status.message() << "\n";
  return 1;
}

}  // namespace
}  // namespace duet::authoring

int main(int argc, char** argv) {
  return duet::base::FinishOutput("duet-keyframe", duet::authoring::Run(argc, argv));
}
