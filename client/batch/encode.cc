#include "client/batch/encode.h"

#include <iterator>
#include <utility>

#include "client/batch/capture_layout.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_export.h"
#include "model/formats/flat/csv.h"
#include "model/formats/flat/json_motion.h"
#include "model/formats/flat/npy.h"
#include "model/formats/flat/sbu_text.h"
#include "model/formats/gltf/gltf_export.h"
#include "model/motion/recorded_motion.h"
#include "model/motion/resample.h"

namespace duet::client::batch {
namespace {

absl::StatusOr<std::vector<EncodedFile>> EncodeBvh(const motion::ClipPair& pair,
                                                   const motion::Skeleton& skeleton) {
  const absl::StatusOr<formats::bvh::BvhDocument> leader =
      formats::bvh::ToBvh(pair.leader, skeleton);
  if (!leader.ok()) return leader.status();
  const absl::StatusOr<formats::bvh::BvhDocument> follower =
      formats::bvh::ToBvh(pair.follower, skeleton);
  if (!follower.ok()) return follower.status();
  return std::vector<EncodedFile>{{".leader.bvh", FormatBvh(*leader)},
                                  {".follower.bvh", FormatBvh(*follower)}};
}

// The file omits labels and model, which are in the index.
absl::StatusOr<std::vector<EncodedFile>> EncodeGlb(const motion::ClipPair& pair,
                                                   const motion::Skeleton& skeleton) {
  absl::StatusOr<std::string> content = formats::gltf::FormatGltf(
      {pair.leader, pair.follower}, skeleton, nullptr, formats::gltf::GltfContainer::kBinary);
  if (!content.ok()) return content.status();
  return std::vector<EncodedFile>{{".glb", *std::move(content)}};
}

absl::StatusOr<std::vector<EncodedFile>> EncodeFormat(Format format, const motion::ClipPair& pair,
                                                      const motion::Skeleton& skeleton) {
  switch (format) {
    case Format::kBvh:
      return EncodeBvh(pair, skeleton);
    case Format::kCsv:
      return std::vector<EncodedFile>{{".csv", formats::flat::FormatCsv(pair)}};
    case Format::kNpy:
      return std::vector<EncodedFile>{{".npy", formats::flat::FormatNpy(pair)}};
    case Format::kGlb:
      return EncodeGlb(pair, skeleton);
    case Format::kJson:
      break;
  }
  return std::vector<EncodedFile>{{".json", formats::flat::FormatJsonMotion(pair, skeleton)}};
}

absl::StatusOr<std::vector<EncodedFile>> EncodeCapture(const dataset::DatasetLayout& captures,
                                                       formats::Side leader_side,
                                                       const motion::ClipPair& pair) {
  formats::flat::SbuOptions options;
  options.joint_names = captures.skeleton.joint_names;
  options.frame_rate_hz = captures.frame_rate_hz;
  options.coordinates = captures.coordinates;
  formats::flat::SbuRecording people = {pair.leader, pair.follower};
  if (leader_side == formats::Side::kRight) std::swap(people.left, people.right);
  absl::StatusOr<std::string> text = FormatSbu(people, options);
  if (!text.ok()) return text.status();
  return std::vector<EncodedFile>{{".txt", *std::move(text)}};
}

motion::Clip AtRate(motion::Clip clip, double rate_hz) {
  if (clip.frame_rate_hz == rate_hz || clip.frame_count() < 2) return clip;
  clip.poses = motion::Resample(clip.poses, clip.frame_rate_hz, rate_hz);
  clip.frame_rate_hz = rate_hz;
  return clip;
}

}  // namespace

std::vector<std::string> EndingsOf(Format format) {
  switch (format) {
    case Format::kBvh:
      return {".leader.bvh", ".follower.bvh"};
    case Format::kCsv:
      return {".csv"};
    case Format::kNpy:
      return {".npy"};
    case Format::kGlb:
      return {".glb"};
    case Format::kJson:
      break;
  }
  return {".json"};
}

std::optional<double> RateOf(const Output& output) {
  const dataset::DatasetLayout* const captures = CapturesOf(output.layout);
  return captures == nullptr ? output.frame_rate_hz : captures->frame_rate_hz;
}

motion::ClipPair AtOutputRate(motion::ClipPair pair, const Output& output) {
  const std::optional<double> rate_hz = RateOf(output);
  if (!rate_hz.has_value()) return pair;
  return {AtRate(std::move(pair.leader), *rate_hz), AtRate(std::move(pair.follower), *rate_hz)};
}

absl::StatusOr<std::vector<EncodedFile>> Encode(const Output& output, formats::Side leader_side,
                                                const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton) {
  absl::Status status = CheckPair(pair);
  if (!status.ok()) return status;
  const dataset::DatasetLayout* const captures = CapturesOf(output.layout);
  if (captures != nullptr) return EncodeCapture(*captures, leader_side, pair);
  std::vector<EncodedFile> all;
  for (const Format format : output.formats) {
    absl::StatusOr<std::vector<EncodedFile>> files = EncodeFormat(format, pair, skeleton);
    if (!files.ok()) return files.status();
    std::move(files->begin(), files->end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace duet::client::batch
