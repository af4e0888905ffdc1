#ifndef DUET_SERVER_CONFIG_CGROUPS_H_
#define DUET_SERVER_CONFIG_CGROUPS_H_

#include <filesystem>
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

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_CGROUPS_H_
