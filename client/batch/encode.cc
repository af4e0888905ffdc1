#include "client/batch/encode.h"

#include <utility>

#include "model/formats/motion_file.h"
#include "model/motion/recorded_motion.h"
#include "model/motion/resample.h"

namespace duet::client::batch {
namespace {

formats::Format FileFormat(v1::Format format) {
  switch (format) {
    case v1::FORMAT_BVH:
      return formats::Format::kBvh;
    case v1::FORMAT_GLB:
      return formats::Format::kGlb;
    default:
      return formats::Format::kNpy;
  }
}

// The files omit labels and model, which are in the index.
absl::Status AddFiles(v1::Format format, const motion::ClipPair& pair,
                      const motion::Skeleton& skeleton, std::vector<EncodedFile>* all) {
  const std::vector<std::string> endings = EndingsOf(format);
  const bool together = endings.size() == 1;
  for (size_t i = 0; i < endings.size(); ++i) {
    const motion::Clip& person = i == 0 ? pair.leader : pair.follower;
    absl::StatusOr<std::string> content =
        formats::FormatPeople(FileFormat(format),
                              together ? std::vector<motion::Clip>{pair.leader, pair.follower}
                                       : std::vector<motion::Clip>{person},
                              skeleton);
    if (!content.ok()) return content.status();
    all->push_back({endings[i], *std::move(content)});
  }
  return absl::OkStatus();
}

motion::Clip AtRate(motion::Clip clip, double rate_hz) {
  if (clip.frame_rate_hz == rate_hz || clip.frame_count() < 2) return clip;
  clip.poses = motion::Resample(clip.poses, clip.frame_rate_hz, rate_hz);
  clip.frame_rate_hz = rate_hz;
  return clip;
}

}  // namespace

std::vector<std::string> EndingsOf(v1::Format format) {
  switch (format) {
    case v1::FORMAT_BVH:
      return {".leader.bvh", ".follower.bvh"};
    case v1::FORMAT_GLB:
      return {".glb"};
    default:
      return {".npy"};
  }
}

motion::ClipPair AtOutputRate(motion::ClipPair pair, const v1::Output& output) {
  if (!output.has_frame_rate_hz()) return pair;
  const double rate_hz = output.frame_rate_hz();
  return {AtRate(std::move(pair.leader), rate_hz), AtRate(std::move(pair.follower), rate_hz)};
}

absl::StatusOr<std::vector<EncodedFile>> Encode(const v1::Output& output,
                                                const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton) {
  absl::Status status = CheckPair(pair);
  if (!status.ok()) return status;
  std::vector<EncodedFile> all;
  for (const int format : output.formats()) {
    status = AddFiles(static_cast<v1::Format>(format), pair, skeleton, &all);
    if (!status.ok()) return status;
  }
  return all;
}

}  // namespace duet::client::batch
