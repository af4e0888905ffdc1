#ifndef DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_
#define DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace duet::server::config {

// The folders in which the kernel shows the limits that apply to this process: those of its own
// cgroup and of each ancestor, because every one of them limits it. A folder may not exist: inside
// a container the process's own cgroup appears as the top, whatever path the kernel reports.
struct CgroupFolders {
  std::vector<std::filesystem::path> version_1;  // of the controller's own hierarchy
  std::vector<std::filesystem::path> version_2;
};

// Finds the folders of a controller, such as "cpu" or "memory". `system_root` is "/" except in
// tests.
CgroupFolders FindCgroups(const std::filesystem::path& system_root, const std::string& controller);

// The first line of a file; empty if the file cannot be read.
std::string FirstLine(const std::filesystem::path& path);

// Returns the cores that a cgroup's cpu.max ("<quota> <period>" in microseconds, or "max <period>")
// grants, or nullopt if it sets no limit or is malformed.
std::optional<double> ParseCpuMax(const std::string& text);

// Returns the cores that this process may keep busy, at least 1: the tightest of its cgroups'
// limits (version 1 and 2) and of the processors that the calling thread may run on. More threads
// than this throttle each other: with a limit of 4 cores, 40 busy threads run for 10 ms of every
// 100.
//
// `system_root` is "/" except in tests.
int AvailableCores(const std::filesystem::path& system_root = "/");

inline constexpr std::uint64_t kUnlimitedMemory = std::numeric_limits<std::uint64_t>::max();

// The memory in bytes that this process may use: the tightest of its cgroups' limits (version 1 and
// 2) and the machine's memory. kUnlimitedMemory if none of them can be read. A process that exceeds
// its cgroup's limit is killed. memory.high of version 2 counts as a limit: above it the kernel
// slows the process down until it hardly makes progress.
//
// `system_root` is "/" except in tests.
std::uint64_t AvailableMemory(const std::filesystem::path& system_root = "/");

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_
