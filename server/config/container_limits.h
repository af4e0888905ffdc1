#ifndef DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_
#define DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "duet/v1/server_config.pb.h"

namespace duet::server::config {

// Returns the cores that this process may keep busy, at least 1: the tightest of its cgroups'
// limits (version 2) and of the processors that the calling thread may run on. More threads
// than this throttle each other: with a limit of 4 cores, 40 busy threads run for 10 ms of every
// 100.
//
// `system_root` is "/" except in tests.
int AvailableCores(const std::filesystem::path& system_root = "/");

inline constexpr std::uint64_t kUnlimitedMemory = std::numeric_limits<std::uint64_t>::max();

// The memory in bytes that this process may use: the tightest of its cgroups' limits (version 2)
// and the machine's memory. kUnlimitedMemory if none of them can be read. A process that exceeds
// its cgroup's limit is killed. memory.high counts as a limit: above it the kernel
// slows the process down until it hardly makes progress.
//
// `system_root` is "/" except in tests.
std::uint64_t AvailableMemory(const std::filesystem::path& system_root = "/");

// The most memory, in bytes, that the server needs for what its settings admit.
// docs/costs.md#memory derives every term from measurements.
struct MemoryNeed {
  std::uint64_t program = 0;    // code, models, the workers, a reload of the models
  std::uint64_t calls = 0;      // windows and unread frames of max_calls calls
  std::uint64_t transport = 0;  // requests being received
  std::uint64_t held = 0;       // requests of calls being answered
  std::uint64_t parsing = 0;    // one request of the largest size

  std::uint64_t total() const { return program + calls + transport + held + parsing; }
};

MemoryNeed NeedOf(const v1::ServerConfig& settings);

// FitCallsToMemory sets max_calls and max_request_bytes, FitBytesToMemory then max_transport_bytes
// and max_held_bytes, each unless `given` has it, so that NeedOf(*settings) fits into
// settings->memory_limit_bytes(). The first two shrink only if memory is short; the other two get
// the rest. None falls below what one call needs, even if that does not fit. Both use workers.
void FitCallsToMemory(const v1::ServerConfig& given, v1::ServerConfig* settings);
void FitBytesToMemory(const v1::ServerConfig& given, v1::ServerConfig* settings);

// Returns one line, with the numbers, for each way in which the settings do not fit the memory.
// `available` is AvailableMemory(); `resident` is the memory that the server uses before it has
// answered a call, 0 if unknown.
std::vector<std::string> MemoryWarnings(const v1::ServerConfig& settings, std::uint64_t available,
                                        std::uint64_t resident = 0);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_CONTAINER_LIMITS_H_
