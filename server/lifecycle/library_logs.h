#ifndef DUET_SERVER_LIFECYCLE_LIBRARY_LOGS_H_
#define DUET_SERVER_LIFECYCLE_LIBRARY_LOGS_H_

#include "server/metrics/json_log.h"

namespace duet::server::lifecycle {

// Writes the messages of gRPC and Protobuf to the log as JSON while it exists, so that every line
// of the server's output parses.
//
// Threads: construct it before gRPC starts; at most one exists at a time.
class LibraryLogs {
 public:
  // `log` outlives it.
  explicit LibraryLogs(metrics::JsonLog& log);
  ~LibraryLogs();
  LibraryLogs(const LibraryLogs&) = delete;
  LibraryLogs& operator=(const LibraryLogs&) = delete;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_LIBRARY_LOGS_H_
