#include "server/config/cpu_budget.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <thread>

namespace duet::server::config {
namespace {

namespace fs = std::filesystem;

std::string ReadLineOf(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// A line of /proc/self/cgroup, "<number>:<controllers>:/<path>", as far as it matters here.
struct CgroupLine {
  bool version_2 = false;  // no controllers: the one hierarchy of version 2
  bool has_cpu = false;    // version 1's hierarchy of the controller "cpu"
  fs::path path;           // without the leading "/"
};

CgroupLine ParseCgroupLine(const std::string& line) {
  const std::size_t first = line.find(':');
  const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
  if (second == std::string::npos || line.compare(second, 2, ":/") != 0) return {};
  const std::string controllers = line.substr(first + 1, second - first - 1);
  // Enclosed in commas, so that "cpuacct" and "cpuset" are other names.
  const bool has_cpu = ("," + controllers + ",").find(",cpu,") != std::string::npos;
  return {controllers.empty(), has_cpu, line.substr(second + 2)};
}

std::optional<double> LimitOfVersion2(const fs::path& cgroup) {
  return ParseCpuMax(ReadLineOf(cgroup / "cpu.max"));
}

// A quota of -1, no number above 0, is none.
std::optional<double> LimitOfVersion1(const fs::path& cgroup) {
  return ParseCpuMax(ReadLineOf(cgroup / "cpu.cfs_quota_us") + " " +
                     ReadLineOf(cgroup / "cpu.cfs_period_us"));
}

// The tightest limit of a cgroup below `top` and its ancestors, which limit as well. Inside a
// container its own cgroup appears as the top, and the path that the kernel tells may not exist.
template <typename LimitOf>
double TightestLimit(double cores, const fs::path& top, fs::path cgroup, LimitOf limit_of) {
  while (true) {
    cores = std::min(cores, limit_of(top / cgroup).value_or(cores));
    if (cgroup.empty()) return cores;
    cgroup = cgroup.parent_path();
  }
}

// The processors that the scheduler may put this thread on: those of `taskset` and of a cpuset.
double AffinityCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return CPU_COUNT(&set);
  // More processors than the set has room for.
  return std::thread::hardware_concurrency();
}

}  // namespace

std::optional<double> ParseCpuMax(const std::string& text) {
  std::istringstream fields(text);
  double quota = 0;
  double period = 0;
  // "max" is no number.
  if (!(fields >> quota >> period) || !(quota > 0) || !(period > 0)) return std::nullopt;
  return quota / period;
}

int AvailableCores(const fs::path& system_root) {
  double cores = AffinityCores();
  const fs::path top = system_root / "sys/fs/cgroup";
  fs::path version_1, version_2;
  std::ifstream file(system_root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const CgroupLine cgroup = ParseCgroupLine(line);
    if (cgroup.version_2) version_2 = cgroup.path;
    if (cgroup.has_cpu) version_1 = cgroup.path;
  }
  cores = TightestLimit(cores, top, version_2, LimitOfVersion2);
  cores = TightestLimit(cores, top / "cpu", version_1, LimitOfVersion1);
  return std::max(1, static_cast<int>(std::floor(cores)));
}

}  // namespace duet::server::config
