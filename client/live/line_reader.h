#ifndef DUET_CLIENT_LIVE_LINE_READER_H_
#define DUET_CLIENT_LIVE_LINE_READER_H_

#include <cstddef>
#include <istream>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"

namespace duet::client::live {

// The longest line that is read, in bytes.
inline constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

// Lines of an input that may be slow, such as a pipe.
//
// Threads: Next is called by one thread; Stop by any.
class LineReader {
 public:
  virtual ~LineReader() = default;
  // Blocks until the next line, which it returns without its end. Absent: the end of the input, or
  // Stop was called. Errors: INVALID_ARGUMENT for a line of more than kMaxLineBytes.
  virtual absl::StatusOr<std::optional<std::string>> Next() = 0;
  virtual void Stop() = 0;
};

// Reads a file descriptor, which it does not close. Stop interrupts Next.
std::unique_ptr<LineReader> ReadLinesOf(int descriptor);
// Reads a stream, which outlives the reader. Stop takes effect at the next line.
std::unique_ptr<LineReader> ReadLinesOf(std::istream& in);

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_LINE_READER_H_
