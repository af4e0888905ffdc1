#ifndef DUET_SERVER_REGISTRY_CHECKPOINT_FINGERPRINT_H_
#define DUET_SERVER_REGISTRY_CHECKPOINT_FINGERPRINT_H_

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace duet::server::registry {

// The content of a checkpoint's files at one moment: the regular files in its folder, except hidden
// files and documents (*.md), which no engine reads.
//
// A file is unchanged if its device, inode, size, modification time and change time are equal.
// Otherwise its SHA-256 digest decides if the size is equal, so that a copy or a `touch` is not a
// change, and large files are read only if necessary. The times of a file that was written less
// than two seconds before the check are ignored, because a second write within the resolution of
// the file system's clock would not change them.
//
// Threads: not safe to call concurrently.
class CheckpointFingerprint {
 public:
  using Clock = std::chrono::system_clock;
  using Time = Clock::time_point;

  // Matches no folder.
  CheckpointFingerprint() = default;
  // Asked before each block of a file that is read; true ends the reading. Null: never.
  using Stop = std::function<bool()>;

  // The files of a checkpoint folder, whose content is not read yet. Matches no folder before
  // ReadContent. For a folder without files, matches no folder.
  static CheckpointFingerprint Of(const std::filesystem::path& folder, Time now = Clock::now());
  // Reads every file once. `folder`: that of Of. If it is stopped, matches no folder.
  void ReadContent(const std::filesystem::path& folder, const Stop& stop = nullptr);

  // Returns true if the files in `folder` have this content. Remembers the times of unchanged
  // files, so that the next call does not read them. Returns false if it is stopped.
  bool Matches(const std::filesystem::path& folder, Time now = Clock::now(),
               const Stop& stop = nullptr);

  // Returns true if no file in `folder` was written since, according to the file system. Reads no
  // content.
  bool IsUntouched(const std::filesystem::path& folder) const;

 private:
  struct File {
    std::string stamp;     // what the file system says of it
    bool settled = false;  // whether the stamp would show a later write
    std::int64_t bytes = 0;
    std::string digest;  // of its content; empty if it was not read or cannot be
  };
  using Files = std::map<std::string, File>;

  // The files of a folder by name, without digests.
  static Files List(const std::filesystem::path& folder, Time now);
  // Whether these are the same files by name and size.
  bool HasSizesOf(const Files& found) const;

  Files files_;
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_CHECKPOINT_FINGERPRINT_H_
