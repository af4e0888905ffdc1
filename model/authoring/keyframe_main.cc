// duet-keyframe: makes a BVH clip from a hand-written key-frame file.
//
//   duet-keyframe samples/keyframes/kick.txt --out samples/kick.bvh

#include <iostream>
#include <string>

#include "CLI/CLI.hpp"
#include "absl/status/status.h"
#include "model/formats/bvh/bvh_export.h"
#include "model/authoring/keyframes.h"
#include "model/base/text.h"
#include "model/motion/skeleton.h"

namespace duet {
namespace {

absl::Status Convert(const std::string& keyframes, const std::string& out) {
  const absl::StatusOr<std::string> text = ReadFile(keyframes);
  if (!text.ok()) return text.status();
  const absl::StatusOr<Clip> clip = ParseKeyframes(*text, keyframes);
  if (!clip.ok()) return clip.status();
  const absl::StatusOr<BvhDocument> document = ToBvh(*clip, SbuSkeleton());
  if (!document.ok()) return document.status();
  return WriteFile(out, FormatBvh(*document));
}

}  // namespace
}  // namespace duet

int main(int argc, char** argv) {
  CLI::App app("Makes a BVH clip from a hand-written key-frame file.", "duet-keyframe");
  std::string keyframes, out;
  app.add_option("keyframes", keyframes, "Key-frame text (docs/formats.md)")->required();
  app.add_option("--out", out, "The BVH file to write")->required();
  CLI11_PARSE(app, argc, argv);
  const absl::Status status = duet::Convert(keyframes, out);
  if (status.ok()) return 0;
  std::cerr << "duet-keyframe: " << status.message() << "\n";
  return 1;
}
