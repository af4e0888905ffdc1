#ifndef DUET_SERVER_CONFIG_CPU_BUDGET_H_
#define DUET_SERVER_CONFIG_CPU_BUDGET_H_

#include <filesystem>
#include <optional>
#include <string>

namespace duet::server::config {

// The cores that a cgroup's cpu.max ("<quota> <period>" microseconds, or "max <period>") grants;
// nothing when it sets no limit or is malformed.
std::optional<double> ParseCpuMax(const std::string& text);

// The cores that this process may keep busy, 1 or more: the tightest of its cgroups' limits
// (version 1 and 2) and of the processors that the calling thread may run on. More threads than
// this throttle each other: a limit of 4 on 40 cores leaves 10 ms of every 100.
//
// `system_root` is "/" but in tests.
int AvailableCores(const std::filesystem::path& system_root = "/");

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_CPU_BUDGET_H_
