#include "server/metrics/server_metrics.h"

#include <prometheus/text_serializer.h>

#include <utility>

#include "absl/status/status.h"

namespace duet::server::metrics {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Labels;

// From a millisecond to a minute: a window takes tens of milliseconds, a long clip a minute.
const prometheus::Histogram::BucketBoundaries& SecondsBuckets() {
  static const auto* const buckets = new prometheus::Histogram::BucketBoundaries{
      0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60};
  return *buckets;
}

const prometheus::Histogram::BucketBoundaries& BatchBuckets() {
  static const auto* const buckets =
      new prometheus::Histogram::BucketBoundaries{1, 2, 4, 8, 16, 32, 64};
  return *buckets;
}

Labels MethodLabels(const MethodInfo& method) {
  return {{"grpc_type", std::string(method.type)},
          {"grpc_service", std::string(method.service)},
          {"grpc_method", std::string(method.name)}};
}

// The spelling of go-grpc-prometheus, which dashboards expect: "OK", "InvalidArgument".
std::string CodeLabel(absl::StatusCode code) {
  static constexpr const char* kNames[] = {
      "OK",       "Canceled",       "Unknown",          "InvalidArgument",   "DeadlineExceeded",
      "NotFound", "AlreadyExists",  "PermissionDenied", "ResourceExhausted", "FailedPrecondition",
      "Aborted",  "OutOfRange",     "Unimplemented",    "Internal",          "Unavailable",
      "DataLoss", "Unauthenticated"};
  return kNames[static_cast<int>(code)];
}

Labels PriorityLabels(batching::Priority priority) {
  return {{"priority", std::string(PriorityName(priority))}};
}

}  // namespace

ServerMetrics::ServerMetrics()
    : started_(BuildCounter()
                   .Name("grpc_server_started_total")
                   .Help("RPCs started on the server.")
                   .Register(registry_)),
      handled_(BuildCounter()
                   .Name("grpc_server_handled_total")
                   .Help("RPCs completed on the server, whatever their outcome.")
                   .Register(registry_)),
      handling_seconds_(BuildHistogram()
                            .Name("grpc_server_handling_seconds")
                            .Help("Time from an RPC's start to its status.")
                            .Register(registry_)),
      in_flight_(BuildGauge()
                     .Name("duet_calls_in_flight")
                     .Help("RPCs being answered.")
                     .Register(registry_)),
      first_chunk_seconds_(BuildHistogram()
                               .Name("duet_first_chunk_seconds")
                               .Help("Time from a Synthesize call's start to its first chunk.")
                               .Register(registry_)),
      frames_(BuildCounter()
                  .Name("duet_frames_total")
                  .Help("Follower frames sent.")
                  .Register(registry_)),
      queue_seconds_(BuildHistogram()
                         .Name("duet_queue_seconds")
                         .Help("Time that a window waited for a worker.")
                         .Register(registry_)),
      compute_seconds_(BuildHistogram()
                           .Name("duet_compute_seconds")
                           .Help("Time of one batch in the network.")
                           .Register(registry_)
                           .Add({}, SecondsBuckets())),
      batch_size_(BuildHistogram()
                      .Name("duet_batch_size")
                      .Help("Windows evaluated together.")
                      .Register(registry_)
                      .Add({}, BatchBuckets())),
      windows_dropped_(
          BuildCounter()
              .Name("duet_windows_dropped_total")
              .Help("Windows that never started: cancelled, or not to be done in time.")
              .Register(registry_)),
      queued_windows_(BuildGauge()
                          .Name("duet_queued_windows")
                          .Help("Windows waiting for a worker.")
                          .Register(registry_)
                          .Add({})),
      load_seconds_(BuildGauge()
                        .Name("duet_model_load_seconds")
                        .Help("Time that loading a checkpoint took.")
                        .Register(registry_)),
      model_state_(BuildGauge()
                       .Name("duet_model_state")
                       .Help("1 when a checkpoint is served, 0 when it failed to load or was "
                             "unloaded.")
                       .Register(registry_)),
      model_loads_(BuildCounter()
                       .Name("duet_model_loads_total")
                       .Help("Checkpoints that were loaded, or refused.")
                       .Register(registry_)),
      folders_skipped_(BuildGauge()
                           .Name("duet_model_folders_skipped")
                           .Help("Folders in the model repository that are no checkpoints.")
                           .Register(registry_)
                           .Add({})),
      reloads_(BuildCounter()
                   .Name("duet_reloads_total")
                   .Help("Reloads of settings and models that were asked for.")
                   .Register(registry_)),
      log_lines_dropped_(
          BuildCounter()
              .Name("duet_log_lines_dropped_total")
              .Help("Log lines dropped because whoever reads the log did not keep up.")
              .Register(registry_)
              .Add({})) {}

void ServerMetrics::CallStarted(const MethodInfo& method) {
  started_.Add(MethodLabels(method)).Increment();
  in_flight_.Add({{"method", std::string(method.name)}}).Increment();
}

void ServerMetrics::CallFinished(const CallRecord& record) {
  Labels labels = MethodLabels(record.method);
  handling_seconds_.Add(labels, SecondsBuckets()).Observe(record.total_seconds);
  labels["grpc_code"] = CodeLabel(record.status.code());
  handled_.Add(labels).Increment();
  in_flight_.Add({{"method", std::string(record.method.name)}}).Decrement();
  if (record.first_chunk_seconds >= 0) {
    first_chunk_seconds_.Add({{"priority", std::string(record.priority)}}, SecondsBuckets())
        .Observe(record.first_chunk_seconds);
  }
  if (record.frames > 0) {
    frames_.Add({{"model", record.model}, {"version", std::to_string(record.version)}})
        .Increment(record.frames);
  }
}

void ServerMetrics::WindowFinished(batching::Priority priority,
                                   const batching::WindowTimings& timings) {
  queue_seconds_.Add(PriorityLabels(priority), SecondsBuckets()).Observe(timings.queue_seconds);
  if (timings.batch_size == 0) {
    windows_dropped_.Add(PriorityLabels(priority)).Increment();
  }
}

void ServerMetrics::BatchFinished(const batching::WindowTimings& timings) {
  compute_seconds_.Observe(timings.compute_seconds);
  batch_size_.Observe(timings.batch_size);
}

void ServerMetrics::ModelLoaded(const std::string& checkpoint, double seconds, bool loaded,
                                bool served) {
  const Labels labels = {{"checkpoint", checkpoint}};
  load_seconds_.Add(labels).Set(seconds);
  model_state_.Add(labels).Set(served ? 1 : 0);
  model_loads_.Add({{"result", loaded ? "ok" : "refused"}}).Increment();
}

void ServerMetrics::ModelUnloaded(const std::string& checkpoint) {
  model_state_.Add({{"checkpoint", checkpoint}}).Set(0);
}

void ServerMetrics::FoldersSkipped(int folders) { folders_skipped_.Set(folders); }

void ServerMetrics::Reloaded(bool ok) {
  reloads_.Add({{"result", ok ? "ok" : "failed"}}).Increment();
}

void ServerMetrics::SetQueueLength(std::function<double()> queued_windows) {
  queue_length_ = std::move(queued_windows);
}

void ServerMetrics::SetDroppedLogLines(std::function<double()> dropped_log_lines) {
  dropped_log_lines_ = std::move(dropped_log_lines);
}

std::string ServerMetrics::Render() {
  common::MutexLock lock(render_mutex_);
  if (queue_length_) queued_windows_.Set(queue_length_());
  if (dropped_log_lines_) {
    log_lines_dropped_.Increment(dropped_log_lines_() - log_lines_dropped_.Value());
  }
  return prometheus::TextSerializer().Serialize(registry_.Collect());
}

}  // namespace duet::server::metrics
