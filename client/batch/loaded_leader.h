#ifndef DUET_CLIENT_BATCH_LOADED_LEADER_H_
#define DUET_CLIENT_BATCH_LOADED_LEADER_H_

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/leaders.h"
#include "client/batch/recipe.h"
#include "client/request.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// A leader's motion in a model's joints, and the start of its follower.
struct LoadedLeader {
  motion::Clip clip;
  std::string sha256;        // of the file
  std::string start_sha256;  // of the file of the follower's start, if that is another one
  std::optional<FollowerStart> follower_start;
};

// Reads the leader's file and the file of the follower's start, and checks the length and the rate
// against the server's limits; a limit of 0 is unknown. Errors name the file.
absl::StatusOr<LoadedLeader> LoadLeader(const LeaderEntry& entry, formats::Side side,
                                        const LeaderInput& input, const motion::Skeleton& skeleton,
                                        const RequestLimits& limits);

// A leader that several items share. The first item that needs it reads it; the last one frees it.
//
// Threads: safe to call concurrently.
class SharedLeader {
 public:
  SharedLeader(std::shared_ptr<const LeaderEntry> entry, formats::Side side)
      : entry_(std::move(entry)), side_(side) {}

  const absl::StatusOr<LoadedLeader>& Get(const LeaderInput& input,
                                          const motion::Skeleton& skeleton,
                                          const RequestLimits& limits) {
    std::call_once(once_, [&] { loaded_ = LoadLeader(*entry_, side_, input, skeleton, limits); });
    return loaded_;
  }

 private:
  std::shared_ptr<const LeaderEntry> entry_;
  formats::Side side_;
  std::once_flag once_;
  absl::StatusOr<LoadedLeader> loaded_;
};

// Shares leaders between the items of a plan, which come leader by leader: the last leader in each
// skeleton. Manifest lines that name the same file and the same start share it too.
class LastLeaders {
 public:
  explicit LastLeaders(size_t skeletons) : last_(skeletons) {}

  std::shared_ptr<SharedLeader> Get(const std::shared_ptr<const LeaderEntry>& entry,
                                    formats::Side side, int skeleton);

 private:
  struct Last {
    std::shared_ptr<const LeaderEntry> entry;
    formats::Side side = formats::Side::kLeft;
    std::shared_ptr<SharedLeader> leader;
  };
  std::vector<Last> last_;  // by skeleton
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LOADED_LEADER_H_
