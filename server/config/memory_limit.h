#ifndef DUET_SERVER_CONFIG_MEMORY_LIMIT_H_
#define DUET_SERVER_CONFIG_MEMORY_LIMIT_H_

#include <cstdint>
#include <filesystem>
#include <limits>

namespace duet::server::config {

inline constexpr std::uint64_t kUnlimitedMemory = std::numeric_limits<std::uint64_t>::max();

// The memory in bytes that this process may use: the tightest of its cgroups' limits (version 1 and
// 2) and the machine's memory. kUnlimitedMemory if none of them can be read. A process that exceeds
// its cgroup's limit is killed. memory.high of version 2 counts as a limit: above it the kernel
// slows the process down until it hardly makes progress.
//
// `system_root` is "/" except in tests.
std::uint64_t AvailableMemory(const std::filesystem::path& system_root = "/");

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_MEMORY_LIMIT_H_
