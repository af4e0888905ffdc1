#include "server/metrics/log_sink.h"

#include <cstddef>
#include <string>

namespace duet::server::metrics {

StreamLogSink::StreamLogSink(std::FILE* stream) : stream_(stream) {
  // On a full disk, a buffer would write its rest later, in the middle of other lines.
  std::setvbuf(stream_, nullptr, _IONBF, 0);
}

bool StreamLogSink::Write(std::string_view line) {
  common::MutexLock lock(mutex_);
  std::string whole = torn_ ? "\n" : "";
  whole += line;
  whole += '\n';
  const std::size_t written = std::fwrite(whole.data(), 1, whole.size(), stream_);
  if (written == whole.size()) {
    torn_ = false;
    return true;
  }
  // If nothing was written, torn_ stays as it is; if only the newline was, the stream ends a line.
  if (written > 0) torn_ = whole[written - 1] != '\n';
  ++dropped_;
  return false;
}

}  // namespace duet::server::metrics
