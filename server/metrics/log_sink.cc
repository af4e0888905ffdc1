#include "server/metrics/log_sink.h"

namespace duet::server::metrics {

void StreamLogSink::Write(std::string_view line) {
  std::string whole(line);
  whole += '\n';
  // One fwrite holds the stream's lock throughout, so lines of different threads do not mix.
  std::fwrite(whole.data(), 1, whole.size(), stream_);
  std::fflush(stream_);
}

}  // namespace duet::server::metrics
