#include "server/config/cpu_budget.h"

#include <algorithm>
#include <cmath>
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

// Where /proc/self/cgroup places this process in the version 2 hierarchy, without a leading "/".
fs::path OwnCgroup(const fs::path& system_root) {
  std::ifstream file(system_root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("0::/", 0) == 0) return line.substr(4);
  }
  return {};
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
  // Takes the processor affinity into account.
  double cores = std::max(1U, std::thread::hardware_concurrency());
  const fs::path top = system_root / "sys/fs/cgroup";
  fs::path cgroup = OwnCgroup(system_root);
  // Every ancestor limits as well; inside a container, its own cgroup appears as the top.
  while (true) {
    const std::optional<double> limit = ParseCpuMax(ReadLineOf(top / cgroup / "cpu.max"));
    if (limit.has_value()) cores = std::min(cores, *limit);
    if (cgroup.empty()) break;
    cgroup = cgroup.parent_path();
  }
  return std::max(1, static_cast<int>(std::floor(cores)));
}

}  // namespace duet::server::config
