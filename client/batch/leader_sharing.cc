#include "client/batch/leader_sharing.h"

#include <utility>

namespace duet::client::batch {
namespace {

// Estimated size of a leader without its positions: its entry, joint names and key.
constexpr size_t kOverheadBytes = 2048;

size_t BytesOf(const motion::Clip& clip) {
  return clip.poses.all().size() * sizeof(motion::Vec3) + kOverheadBytes;
}

// Whether two lines read the same motion.
bool SameMotion(const LeaderEntry& a, const LeaderEntry& b) {
  return a.file == b.file && a.follower_start == b.follower_start &&
         a.follower_start_side == b.follower_start_side;
}

}  // namespace

KeptLeaders::Key KeptLeaders::KeyFor(const LeaderEntry& entry, formats::Side side, int skeleton) {
  const int start_side =
      entry.follower_start_side ? static_cast<int>(*entry.follower_start_side) : -1;
  return {entry.file.string(), static_cast<int>(side), entry.follower_start, start_side, skeleton};
}

void KeptLeaders::Keep(const LeaderEntry& entry, formats::Side side, int skeleton,
                       const motion::Clip& clip, std::shared_ptr<SharedLeader> leader) {
  const size_t bytes = BytesOf(clip);
  if (bytes > max_bytes_ - bytes_) return;
  if (leaders_.try_emplace(KeyFor(entry, side, skeleton), std::move(leader)).second) {
    bytes_ += bytes;
  }
}

std::shared_ptr<SharedLeader> KeptLeaders::Take(const LeaderEntry& entry, formats::Side side,
                                                int skeleton) {
  const auto found = leaders_.find(KeyFor(entry, side, skeleton));
  if (found == leaders_.end()) return nullptr;
  std::shared_ptr<SharedLeader> leader = std::move(found->second);
  leaders_.erase(found);
  return leader;
}

std::shared_ptr<SharedLeader> LastLeaders::Get(const std::shared_ptr<const LeaderEntry>& entry,
                                               formats::Side side, int skeleton) {
  Last& last = last_[static_cast<size_t>(skeleton)];
  if (last.leader != nullptr && last.side == side &&
      (last.entry == entry || SameMotion(*last.entry, *entry))) {
    return last.leader;
  }
  std::shared_ptr<SharedLeader> kept =
      kept_ == nullptr ? nullptr : kept_->Take(*entry, side, skeleton);
  if (kept == nullptr) kept = std::make_shared<SharedLeader>(entry, side);
  last = {entry, side, kept};
  return kept;
}

}  // namespace duet::client::batch
