#ifndef DUET_SERVER_REGISTRY_CHECKPOINT_FINGERPRINT_H_
#define DUET_SERVER_REGISTRY_CHECKPOINT_FINGERPRINT_H_

#include <chrono>
#include <filesystem>
#include <map>
#include <string>

namespace duet::server::registry {

// The content of a checkpoint's files at one moment: the regular files in its folder, except hidden
// files and documents (*.md), which no engine reads.
//
// A file is unchanged if its device, inode, size, modification time and change time are equal.
// Otherwise its SHA-256 digest decides, so that a copy or a `touch` is not a change, and large
// files are read only if necessary. The times of a file that was written less than two seconds
// before the check are ignored, because a second write within the resolution of the file system's
// clock would not change them.
//
// Threads: not safe to call concurrently.
class CheckpointFingerprint {
 public:
  using Clock = std::chrono::system_clock;
  using Time = Clock::time_point;

  // Matches no folder.
  CheckpointFingerprint() = default;
  // Reads every file of a checkpoint folder once. For a folder without files, matches no folder.
  static CheckpointFingerprint Of(const std::filesystem::path& folder, Time now = Clock::now());

  // Returns true if the files in `folder` have this content. Remembers the times of unchanged
  // files, so that the next call does not read them.
  bool Matches(const std::filesystem::path& folder, Time now = Clock::now());

  // Returns true if no file in `folder` was written since, according to the file system. Reads no
  // content.
  bool IsUntouched(const std::filesystem::path& folder) const;

 private:
  struct File {
    std::string stamp;     // what the file system says of it
    bool settled = false;  // whether the stamp would show a later write
    std::string digest;    // of its content; empty if it cannot be read
  };
  using Files = std::map<std::string, File>;

  // The files of a folder by name, without digests.
  static Files List(const std::filesystem::path& folder, Time now);

  Files files_;
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_CHECKPOINT_FINGERPRINT_H_
