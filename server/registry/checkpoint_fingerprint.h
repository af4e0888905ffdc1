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
// A file counts as unchanged if the file system says so (device, inode, size, modification and
// change time). Otherwise the SHA-256 digest of its content decides, so that a copy or a `touch`
// is no change, and large files are read only when there is reason to. The times of a file that was
// written less than two seconds before it was looked at prove nothing: file systems count in ticks,
// and another write in the same tick would not show.
//
// Threads: not safe to call concurrently.
class CheckpointFingerprint {
 public:
  using Clock = std::chrono::system_clock;
  using Time = Clock::time_point;

  // Of no checkpoint: matches nothing.
  CheckpointFingerprint() = default;
  // Reads every file of a checkpoint folder once. Of a folder without files: matches nothing.
  static CheckpointFingerprint Of(const std::filesystem::path& folder, Time now = Clock::now());

  // Whether the files in `folder` have this content. Remembers the times of files whose content
  // turned out to be the same, so that the next call need not read them.
  bool Matches(const std::filesystem::path& folder, Time now = Clock::now());

  // Whether the file system says that nothing in `folder` was written since. Reads no content.
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
