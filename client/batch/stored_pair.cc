#include "client/batch/stored_pair.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/text_values.h"
#include "model/formats/motion_file.h"
#include "model/motion/recorded_motion.h"

namespace duet::client::batch {

absl::StatusOr<motion::ClipPair> ReadStoredPair(
    const std::function<absl::StatusOr<std::string>(size_t)>& read,
    const nlohmann::ordered_json& record, const motion::Skeleton& skeleton) {
  const std::filesystem::path first = record["files"][0]["path"].get<std::string>();
  // BVH has one file for each person.
  const bool apart = first.extension() == ".bvh";
  const absl::StatusOr<std::string> content = read(0);
  if (!content.ok()) return content.status();
  const absl::StatusOr<std::string> other = apart ? read(1) : content;
  if (!other.ok()) return other.status();
  // Only layouts of captures keep the leader on its side.
  const bool leader_right = first.extension() == ".txt" && record["side"] == "right";
  formats::ReadOptions options;
  options.format = formats::FormatOf(first);
  options.skeleton = skeleton;
  options.frame_rate_hz = record["frame_rate_hz"].get<double>();
  options.side = leader_right ? formats::Side::kRight : formats::Side::kLeft;
  absl::StatusOr<motion::Clip> leader = formats::ParseLeader(*content, first.string(), options);
  if (!leader.ok()) return leader.status();
  if (!apart) options.side = OtherSide(options.side);
  absl::StatusOr<motion::Clip> follower = formats::ParseLeader(*other, first.string(), options);
  if (!follower.ok()) return follower.status();
  motion::ClipPair pair = {*std::move(leader), *std::move(follower)};
  absl::Status status = CheckPair(pair);
  if (status.ok()) return pair;
  return absl::Status(status.code(), absl::StrCat(first.string(), ": ", status.message()));
}

}  // namespace duet::client::batch
