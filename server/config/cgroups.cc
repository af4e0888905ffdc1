#include "server/config/cgroups.h"

#include <cstddef>
#include <fstream>
#include <utility>

namespace duet::server::config {
namespace {

namespace fs = std::filesystem;

// A line of /proc/self/cgroup, "<number>:<controllers>:/<path>".
struct CgroupLine {
  bool version_2 = false;       // no controllers: the only hierarchy of version 2
  bool has_controller = false;  // version 1's hierarchy of the controller
  fs::path path;                // without the leading "/"
};

CgroupLine ParseCgroupLine(const std::string& line, const std::string& controller) {
  const std::size_t first = line.find(':');
  const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
  if (second == std::string::npos || line.compare(second, 2, ":/") != 0) return {};
  const std::string controllers = line.substr(first + 1, second - first - 1);
  // Enclosed in commas, because "cpuacct" and "cpuset" are not "cpu".
  const bool has_controller =
      ("," + controllers + ",").find("," + controller + ",") != std::string::npos;
  return {controllers.empty(), has_controller, line.substr(second + 2)};
}

// The cgroup's folder below `top` and those of its ancestors.
std::vector<fs::path> WithAncestors(const fs::path& top, fs::path cgroup) {
  std::vector<fs::path> folders;
  while (true) {
    folders.push_back(top / cgroup);
    if (cgroup.empty()) return folders;
    cgroup = cgroup.parent_path();
  }
}

}  // namespace

CgroupFolders FindCgroups(const fs::path& system_root, const std::string& controller) {
  fs::path version_1, version_2;
  std::ifstream file(system_root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    CgroupLine cgroup = ParseCgroupLine(line, controller);
    if (cgroup.version_2) version_2 = cgroup.path;
    if (cgroup.has_controller) version_1 = std::move(cgroup.path);
  }
  const fs::path top = system_root / "sys/fs/cgroup";
  return {WithAncestors(top / controller, version_1), WithAncestors(top, version_2)};
}

std::string FirstLine(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

}  // namespace duet::server::config
