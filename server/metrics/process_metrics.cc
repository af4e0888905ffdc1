#include "server/metrics/process_metrics.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace duet::server::metrics {
namespace {

using Families = std::vector<prometheus::MetricFamily>;

// Returns the fields of /proc/self/stat after the program's name, which may contain any character.
// The first is the state, field 3 in proc(5).
std::vector<std::string> StatFields() {
  std::ifstream file("/proc/self/stat");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream words(text.substr(name_end + 1));
  return {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()};
}

// The boot time in seconds since 1970.
std::optional<double> BootTime() {
  std::ifstream file("/proc/stat");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string name;
    double seconds = 0;
    if (words >> name >> seconds && name == "btime") return seconds;
  }
  return std::nullopt;
}

void AddStat(Families& families) {
  // Field numbers of proc(5); `fields` begins with number 3.
  constexpr std::size_t kUserTime = 14, kSystemTime = 15, kThreads = 20, kStart = 22,
                        kVirtualMemory = 23, kResidentPages = 24;
  const std::vector<std::string> fields = StatFields();
  if (fields.size() <= kResidentPages - 3) return;
  const auto field = [&fields](std::size_t number) { return std::stod(fields[number - 3]); };
  const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  families.push_back(Counter("process_cpu_seconds_total",
                             "Total user and system CPU time spent in seconds.",
                             (field(kUserTime) + field(kSystemTime)) / ticks));
  families.push_back(Gauge("process_threads", "Number of threads.", field(kThreads)));
  families.push_back(Gauge("process_virtual_memory_bytes", "Virtual memory size in bytes.",
                           field(kVirtualMemory)));
  families.push_back(Gauge("process_resident_memory_bytes", "Resident memory size in bytes.",
                           field(kResidentPages) * static_cast<double>(sysconf(_SC_PAGESIZE))));
  if (const auto boot = BootTime()) {
    families.push_back(Gauge("process_start_time_seconds",
                             "Start time of the process since unix epoch in seconds.",
                             *boot + field(kStart) / ticks));
  }
}

void AddDescriptors(Families& families) {
  std::error_code error;
  const std::filesystem::directory_iterator open("/proc/self/fd", error);
  if (!error) {
    // One of them belongs to this iterator.
    families.push_back(Gauge("process_open_fds", "Number of open file descriptors.",
                             static_cast<double>(std::distance(begin(open), end(open)) - 1)));
  }
  rlimit limit = {};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
    families.push_back(Gauge("process_max_fds", "Maximum number of open file descriptors.",
                             static_cast<double>(limit.rlim_cur)));
  }
}

}  // namespace

std::uint64_t ResidentBytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0, resident = 0;
  if (!(file >> pages >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

prometheus::MetricFamily Gauge(const std::string& name, const std::string& help, double value) {
  prometheus::ClientMetric metric;
  metric.gauge.value = value;
  return {name, help, prometheus::MetricType::Gauge, {metric}};
}

prometheus::MetricFamily Counter(const std::string& name, const std::string& help, double value) {
  prometheus::ClientMetric metric;
  metric.counter.value = value;
  return {name, help, prometheus::MetricType::Counter, {metric}};
}

std::vector<prometheus::MetricFamily> ReadProcessMetrics() {
  Families families;
  AddStat(families);
  AddDescriptors(families);
  return families;
}

}  // namespace duet::server::metrics
