#include "client/batch/stored_pair.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/text_values.h"
#include "model/formats/motion_file.h"
#include "model/motion/recorded_motion.h"

namespace duet::client::batch {

absl::StatusOr<motion::ClipPair> ReadStoredPair(const std::filesystem::path& items,
                                                const nlohmann::ordered_json& record,
                                                const motion::Skeleton& skeleton) {
  const nlohmann::ordered_json& files = record["files"];
  const std::filesystem::path first = items / files[0]["path"].get<std::string>();
  // Of BVH the other person has a file of its own.
  const bool apart = first.extension() == ".bvh";
  const std::filesystem::path second = apart ? items / files[1]["path"].get<std::string>() : first;
  // Only captures' files keep the leader's side.
  const bool leader_right = first.extension() == ".txt" && record["side"] == "right";
  formats::ReadOptions options;
  options.skeleton = skeleton;
  options.frame_rate_hz = record["frame_rate_hz"].get<double>();
  options.side = leader_right ? formats::Side::kRight : formats::Side::kLeft;
  absl::StatusOr<motion::Clip> leader = formats::ReadLeader(first, options);
  if (!leader.ok()) return leader.status();
  if (!apart) options.side = OtherSide(options.side);
  absl::StatusOr<motion::Clip> follower = formats::ReadLeader(second, options);
  if (!follower.ok()) return follower.status();
  motion::ClipPair pair = {*std::move(leader), *std::move(follower)};
  absl::Status status = CheckPair(pair);
  if (status.ok()) return pair;
  return absl::Status(status.code(), absl::StrCat(first.string(), ": ", status.message()));
}

}  // namespace duet::client::batch
