#ifndef DUET_CLIENT_BATCH_LEADERS_H_
#define DUET_CLIENT_BATCH_LEADERS_H_

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/recipe.h"
#include "client/batch/text_values.h"
#include "client/request.h"
#include "client/result.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::client::batch {

// A leader of the list, with its settings.
struct LeaderEntry {
  // Unique name of its outputs: a path relative to the data set, without extension.
  std::string key;
  bool has_id = false;  // the key is the `id` of a manifest
  std::string given;    // as listed
  std::string line;     // "MANIFEST:NUMBER" if it comes from a manifest
  std::filesystem::path file;
  std::optional<formats::Side> side;
  Labels labels;               // if not empty, override the recipe's reactions
  std::string follower_start;  // a point or a file; empty: set by the recipe
  std::optional<motion::Vec3> partner_direction;
  std::string group;  // whose leaders are all in one split; empty: none
  std::optional<uint64_t> seed;
  std::vector<std::pair<std::string, std::string>> extra;  // other columns, by name
};

// A path as a key: every part in UTF-8, without dots and without characters that file systems and
// archives reject, "walks/Kick 1.v2" as "walks/Kick_1_v2". Drops parent folders ("..").
std::string KeyOf(const std::filesystem::path& path);

// A sequence of leaders. Its memory does not depend on the length of the list.
class LeaderSource {
 public:
  virtual ~LeaderSource() = default;
  // The next leader; nullopt at the end. After INVALID_ARGUMENT, which concerns one line, the next
  // call continues with the next line, so that all bad lines can be reported together. Any other
  // error ends the list.
  virtual absl::StatusOr<std::optional<LeaderEntry>> Next() = 0;
};

// Files, and folders: all motion files below, also links to missing ones, by name, except .txt and
// .json files, because these can be anything. Files of a folder are named by their path in it,
// other files by their own name.
//
// Errors: NOT_FOUND for missing inputs; INVALID_ARGUMENT for a file of unknown format, for two
//         leaders with the same key, and if there is no motion file.
absl::StatusOr<std::unique_ptr<LeaderSource>> ListLeaders(const std::vector<std::string>& inputs);

// Reads a manifest line by line: tab-separated values whose first row names the columns
// (docs/batch.md). Relative paths begin at `folder`; errors call the manifest `name`.
std::unique_ptr<LeaderSource> ReadManifest(std::unique_ptr<std::istream> in,
                                           const std::filesystem::path& folder,
                                           const std::string& name);

// Checks inputs before anything else is done: NOT_FOUND for missing ones, and INVALID_ARGUMENT if
// the data set `out` is in a folder of leaders, where the next run would take its files for
// leaders.
absl::Status CheckInputs(const std::vector<std::string>& inputs, const std::filesystem::path& out);

// Reads the start of a follower: X,Y,Z, or a motion file. In the leader's own file, the follower is
// the other person.
absl::StatusOr<FollowerStart> ReadStart(const std::string& start,
                                        const std::filesystem::path& leader,
                                        formats::Side leader_side, formats::ReadOptions options);

// A leader's motion in a model's joints, and the start of its follower.
struct LoadedLeader {
  motion::Clip clip;
  std::string sha256;        // of the file
  std::string start_sha256;  // of the file of the follower's start, if that is another one
  std::optional<FollowerStart> follower_start;
};

// Reads the leader's file and the file of the follower's start. Errors name the file.
absl::StatusOr<LoadedLeader> LoadLeader(const LeaderEntry& entry, formats::Side side,
                                        const LeaderInput& input, const motion::Skeleton& skeleton);

// A leader that several items share. The first item that needs it reads it; the last one frees it.
//
// Threads: safe to call concurrently.
class SharedLeader {
 public:
  SharedLeader(std::shared_ptr<const LeaderEntry> entry, formats::Side side)
      : entry_(std::move(entry)), side_(side) {}

  // Whether an entry reads the same motion.
  bool Is(const LeaderEntry& entry, formats::Side side) const {
    return side == side_ && entry.file == entry_->file &&
           entry.follower_start == entry_->follower_start;
  }

  const absl::StatusOr<LoadedLeader>& Get(const LeaderInput& input,
                                          const motion::Skeleton& skeleton) {
    std::call_once(once_, [&] { loaded_ = LoadLeader(*entry_, side_, input, skeleton); });
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
  std::vector<std::shared_ptr<SharedLeader>> last_;  // by skeleton
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADERS_H_
