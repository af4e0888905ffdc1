#ifndef DUET_SERVER_METRICS_PROCESS_METRICS_H_
#define DUET_SERVER_METRICS_PROCESS_METRICS_H_

#include <prometheus/metric_family.h>

#include <cstdint>
#include <string>
#include <vector>

namespace duet::server::metrics {

// Reads the standard process metrics of Prometheus clients from /proc:
//   process_cpu_seconds_total, process_start_time_seconds, process_threads,
//   process_resident_memory_bytes, process_virtual_memory_bytes, process_open_fds, process_max_fds
// Metrics that cannot be read are omitted.
std::vector<prometheus::MetricFamily> ReadProcessMetrics();

// Returns the resident memory of this process; 0 if it cannot be read.
std::uint64_t ResidentBytes();

// A gauge and a counter without labels.
prometheus::MetricFamily Gauge(const std::string& name, const std::string& help, double value);
prometheus::MetricFamily Counter(const std::string& name, const std::string& help, double value);

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_PROCESS_METRICS_H_
