#include "server/lifecycle/library_logs.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>

#include <atomic>
#include <string>

namespace duet::server::lifecycle {
namespace {

// The libraries accept only plain functions.
std::atomic<metrics::JsonLog*> current_log{nullptr};

void Log(const char* library, bool error, const std::string& message) {
  metrics::JsonLog* log = current_log.load(std::memory_order_acquire);
  if (log == nullptr) return;
  log->Library(library, error ? metrics::Severity::kError : metrics::Severity::kInfo, message);
}

void LogGrpc(gpr_log_func_args* args) {
  Log("grpc", args->severity == GPR_LOG_SEVERITY_ERROR, args->message);
}

void LogProtobuf(google::protobuf::LogLevel level, const char*, int, const std::string& message) {
  // A malformed request is the caller's error, not the server's.
  Log("protobuf", level == google::protobuf::LOGLEVEL_FATAL, message);
}

}  // namespace

LibraryLogs::LibraryLogs(metrics::JsonLog& log) {
  current_log.store(&log, std::memory_order_release);
  gpr_set_log_function(LogGrpc);
  google::protobuf::SetLogHandler(LogProtobuf);
}

LibraryLogs::~LibraryLogs() {
  google::protobuf::SetLogHandler(nullptr);
  gpr_set_log_function(nullptr);
  current_log.store(nullptr, std::memory_order_release);
}

}  // namespace duet::server::lifecycle
