#ifndef DUET_CLIENT_BATCH_LEADER_SHARING_H_
#define DUET_CLIENT_BATCH_LEADER_SHARING_H_

#include <cstddef>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/batch/leader_entry.h"
#include "client/batch/loaded_leader.h"

namespace duet::client::batch {

// Leaders that the check of a plan has read, kept so that the run does not read them again: the
// first ones of the plan, up to a limit of memory.
//
// Threads: concurrent calls need a lock.
class KeptLeaders {
 public:
  explicit KeptLeaders(size_t max_bytes) : max_bytes_(max_bytes) {}

  // Keeps `leader`, which has loaded `clip`, if it fits into the memory that is left.
  void Keep(const LeaderEntry& entry, formats::Side side, int skeleton, const motion::Clip& clip,
            std::shared_ptr<SharedLeader> leader);

  // Removes and returns the leader; null if it is not kept.
  std::shared_ptr<SharedLeader> Take(const LeaderEntry& entry, formats::Side side, int skeleton);

 private:
  // Everything that determines what is read: file, side, the follower's start and its side,
  // skeleton.
  using Key = std::tuple<std::string, int, std::string, int, int>;
  static Key KeyFor(const LeaderEntry& entry, formats::Side side, int skeleton);

  const size_t max_bytes_;
  size_t bytes_ = 0;  // of all that were ever kept
  absl::flat_hash_map<Key, std::shared_ptr<SharedLeader>> leaders_;
};

// Shares leaders between the items of a plan, which come leader by leader: the last leader in each
// skeleton. Manifest lines that name the same file and the same start share it too.
class LastLeaders {
 public:
  // New leaders are taken from `kept`, which may be null.
  explicit LastLeaders(size_t skeletons, KeptLeaders* kept = nullptr)
      : kept_(kept), last_(skeletons) {}

  std::shared_ptr<SharedLeader> Get(const std::shared_ptr<const LeaderEntry>& entry,
                                    formats::Side side, int skeleton);

 private:
  struct Last {
    std::shared_ptr<const LeaderEntry> entry;
    formats::Side side = formats::Side::kLeft;
    std::shared_ptr<SharedLeader> leader;
  };
  KeptLeaders* kept_;
  std::vector<Last> last_;  // by skeleton
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_SHARING_H_
