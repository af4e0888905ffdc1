#include "server/config/container_limits.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace duet::server::config {

namespace {

namespace fs = std::filesystem;

// The first line of a file; empty if the file cannot be read.
std::string FirstLine(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// The folders in which the kernel shows the limits that apply to this process: those of its own
// cgroup and of each ancestor, because every one of them limits it. A folder may not exist: inside
// a container the process's own cgroup appears as the top, whatever path the kernel reports.
std::vector<fs::path> FindCgroups(const fs::path& system_root) {
  constexpr absl::string_view kVersion2 = "0::/";
  fs::path cgroup;
  std::ifstream file(system_root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    if (absl::StartsWith(line, kVersion2)) cgroup = line.substr(kVersion2.size());
  }
  std::vector<fs::path> folders;
  while (true) {
    folders.push_back(system_root / "sys/fs/cgroup" / cgroup);
    if (cgroup.empty()) return folders;
    cgroup = cgroup.parent_path();
  }
}

// Returns the cores that a cgroup's cpu.max ("<quota> <period>" in microseconds, or "max <period>")
// grants, or nullopt if it sets no limit or is malformed.
std::optional<double> ParseCpuMax(const std::string& text) {
  std::istringstream fields(text);
  double quota = 0;
  double period = 0;
  // "max" does not parse as a number.
  if (!(fields >> quota >> period) || !(quota > 0) || !(period > 0)) return std::nullopt;
  return quota / period;
}

// The processors that `taskset` and a cpuset allow this thread.
double AffinityCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return CPU_COUNT(&set);
  // The machine has more processors than the set can hold.
  return std::thread::hardware_concurrency();
}

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

int AvailableCores(const fs::path& system_root) {
  double cores = AffinityCores();
  for (const fs::path& cgroup : FindCgroups(system_root)) {
    cores = std::min(cores, ParseCpuMax(FirstLine(cgroup / "cpu.max")).value_or(cores));
  }
  return std::max(1, static_cast<int>(std::floor(cores)));
}

std::uint64_t AvailableMemory(const fs::path& system_root) {
  std::uint64_t limit = MemoryOfMachine(system_root);
  for (const fs::path& cgroup : FindCgroups(system_root)) {
    limit = std::min({limit, LimitIn(cgroup / "memory.max"), LimitIn(cgroup / "memory.high")});
  }
  return limit;
}

namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

// Measured, and rounded up: docs/costs.md#memory.
constexpr std::uint64_t kProgramBytes = 104 * kMebibyte;
constexpr std::uint64_t kWorkerBytes = 4 * kMebibyte;
constexpr std::uint64_t kCallBytes = 640 << 10;

// In multiples of the largest request. While it is parsed, its bytes exist as they came and as
// numbers, and then as numbers and as positions; one of the two counts as held.
constexpr std::uint64_t kParsing = 1;
constexpr std::uint64_t kLeastTransport = 3;
constexpr std::uint64_t kLeastHeld = 1;
// If memory is not short, as many of the largest requests are received, and as many held, at a
// time.
constexpr std::uint64_t kMostRequests = 16;
// No request of use is smaller.
constexpr std::uint64_t kLeastRequestBytes = kMebibyte;
constexpr std::uint64_t kLeastCalls = 4;

std::uint64_t Left(std::uint64_t of, std::uint64_t taken) { return of > taken ? of - taken : 0; }

std::uint64_t Program(const v1::ServerConfig& settings) {
  return kProgramBytes + settings.workers() * kWorkerBytes;
}

std::uint64_t Calls(const v1::ServerConfig& settings) { return settings.max_calls() * kCallBytes; }

std::string Megabytes(std::uint64_t bytes) { return absl::StrCat(bytes / 1000000, " MB"); }

}  // namespace

MemoryNeed NeedOf(const v1::ServerConfig& settings) {
  return {Program(settings), Calls(settings), settings.max_transport_bytes(),
          settings.max_held_bytes(), kParsing * settings.max_request_bytes()};
}

void FitCallsToMemory(const v1::ServerConfig& given, v1::ServerConfig* settings) {
  const std::uint64_t left = Left(settings->memory_limit_bytes(), Program(*settings));
  if (!given.has_max_calls()) {
    const std::uint64_t most = std::max(kLeastCalls, left / 3 / kCallBytes);
    settings->set_max_calls(
        static_cast<uint32_t>(std::min<std::uint64_t>(most, settings->max_calls())));
  }
  if (!given.has_max_request_bytes()) {
    const std::uint64_t most =
        Left(left, Calls(*settings)) / (kLeastTransport + kLeastHeld + kParsing);
    settings->set_max_request_bytes(std::clamp<std::uint64_t>(
        most / kMebibyte * kMebibyte, kLeastRequestBytes, settings->max_request_bytes()));
  }
}

void FitBytesToMemory(const v1::ServerConfig& given, v1::ServerConfig* settings) {
  const std::uint64_t request = settings->max_request_bytes();
  const std::uint64_t most = kMostRequests * request;
  const std::uint64_t left = Left(settings->memory_limit_bytes(),
                                  Program(*settings) + Calls(*settings) + kParsing * request);
  if (!given.has_max_transport_bytes()) {
    const std::uint64_t share =
        given.has_max_held_bytes() ? Left(left, given.max_held_bytes()) : left / 2;
    settings->set_max_transport_bytes(std::clamp(share, kLeastTransport * request, most));
  }
  if (!given.has_max_held_bytes()) {
    settings->set_max_held_bytes(
        std::clamp(Left(left, settings->max_transport_bytes()), kLeastHeld * request, most));
  }
}

std::vector<std::string> MemoryWarnings(const v1::ServerConfig& settings, std::uint64_t available,
                                        std::uint64_t resident) {
  std::vector<std::string> warnings;
  if (settings.memory_limit_bytes() > available &&
      settings.memory_limit_bytes() != kUnlimitedMemory) {
    warnings.push_back(absl::StrCat("memory_limit_bytes: expected at most ", available,
                                    ", which this machine or its control group allows, got ",
                                    settings.memory_limit_bytes(),
                                    "; above that the kernel ends the server"));
  }
  const std::uint64_t limit = std::min(settings.memory_limit_bytes(), available);
  MemoryNeed need = NeedOf(settings);
  need.program = std::max(need.program, resident);
  if (need.total() <= limit) return warnings;
  warnings.push_back(absl::StrCat(
      "memory: the settings admit requests that need ", Megabytes(need.total()),
      ", and the limit is ", Megabytes(limit), ": ", Megabytes(need.program),
      " for the program and its models, ", Megabytes(need.calls), " for max_calls = ",
      settings.max_calls(), ", ", Megabytes(need.transport), " for max_transport_bytes, ",
      Megabytes(need.held), " for max_held_bytes, ", Megabytes(need.parsing),
      " to parse a request of max_request_bytes; lower these settings or raise the limit, or the "
      "kernel may end the server"));
  return warnings;
}

}  // namespace duet::server::config
