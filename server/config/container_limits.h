#ifndef DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_
#define DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

namespace duet::server::config {

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
