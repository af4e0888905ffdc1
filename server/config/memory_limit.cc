#include "server/config/memory_limit.h"

#include <algorithm>
#include <fstream>
#include <string>

#include "absl/strings/numbers.h"
#include "server/config/cgroups.h"

namespace duet::server::config {
namespace {

namespace fs = std::filesystem;

// "max" is not a number and means no limit; so does a limit of 0, which no process could run under.
std::uint64_t LimitIn(const fs::path& path) {
  std::uint64_t limit = 0;
  if (!absl::SimpleAtoi(FirstLine(path), &limit) || limit == 0) return kUnlimitedMemory;
  return limit;
}

std::uint64_t MemoryOfMachine(const fs::path& system_root) {
  std::ifstream file(system_root / "proc/meminfo");
  std::string key, unit;
  for (std::uint64_t kibibytes = 0; file >> key >> kibibytes; std::getline(file, unit)) {
    if (key == "MemTotal:") return kibibytes << 10;
  }
  return kUnlimitedMemory;
}

}  // namespace

std::uint64_t AvailableMemory(const fs::path& system_root) {
  std::uint64_t limit = MemoryOfMachine(system_root);
  const CgroupFolders cgroups = FindCgroups(system_root, "memory");
  for (const fs::path& cgroup : cgroups.version_2) {
    limit = std::min({limit, LimitIn(cgroup / "memory.max"), LimitIn(cgroup / "memory.high")});
  }
  // Version 1 writes its largest number, which exceeds every machine's memory, for no limit.
  for (const fs::path& cgroup : cgroups.version_1) {
    limit = std::min(limit, LimitIn(cgroup / "memory.limit_in_bytes"));
  }
  return limit;
}

}  // namespace duet::server::config
