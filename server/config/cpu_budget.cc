#include "server/config/cpu_budget.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <thread>

#include "server/config/cgroups.h"

namespace duet::server::config {
namespace {

namespace fs = std::filesystem;

std::optional<double> LimitOfVersion2(const fs::path& cgroup) {
  return ParseCpuMax(FirstLine(cgroup / "cpu.max"));
}

// A quota of -1 means no limit.
std::optional<double> LimitOfVersion1(const fs::path& cgroup) {
  return ParseCpuMax(FirstLine(cgroup / "cpu.cfs_quota_us") + " " +
                     FirstLine(cgroup / "cpu.cfs_period_us"));
}

// The processors that `taskset` and a cpuset allow this thread.
double AffinityCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return CPU_COUNT(&set);
  // The machine has more processors than the set can hold.
  return std::thread::hardware_concurrency();
}

}  // namespace

std::optional<double> ParseCpuMax(const std::string& text) {
  std::istringstream fields(text);
  double quota = 0;
  double period = 0;
  // "max" does not parse as a number.
  if (!(fields >> quota >> period) || !(quota > 0) || !(period > 0)) return std::nullopt;
  return quota / period;
}

int AvailableCores(const fs::path& system_root) {
  double cores = AffinityCores();
  const CgroupFolders cgroups = FindCgroups(system_root, "cpu");
  for (const fs::path& cgroup : cgroups.version_2) {
    cores = std::min(cores, LimitOfVersion2(cgroup).value_or(cores));
  }
  for (const fs::path& cgroup : cgroups.version_1) {
    cores = std::min(cores, LimitOfVersion1(cgroup).value_or(cores));
  }
  return std::max(1, static_cast<int>(std::floor(cores)));
}

}  // namespace duet::server::config
