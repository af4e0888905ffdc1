#include "client/batch/encode.h"

#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_export.h"
#include "model/formats/flat/csv.h"
#include "model/formats/flat/json_motion.h"
#include "model/formats/flat/npy.h"
#include "model/motion/recorded_motion.h"

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

}  // namespace

absl::StatusOr<std::vector<EncodedFile>> Encode(Format format, const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton) {
  absl::Status status = CheckPair(pair);
  if (!status.ok()) return status;
  switch (format) {
    case Format::kBvh:
      return EncodeBvh(pair, skeleton);
    case Format::kCsv:
      return std::vector<EncodedFile>{{".csv", formats::flat::FormatCsv(pair)}};
    case Format::kNpy:
      return std::vector<EncodedFile>{{".npy", formats::flat::FormatNpy(pair)}};
    case Format::kJson:
      break;
  }
  return std::vector<EncodedFile>{{".json", formats::flat::FormatJsonMotion(pair, skeleton)}};
}

}  // namespace duet::client::batch
