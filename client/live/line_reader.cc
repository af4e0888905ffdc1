#include "client/live/line_reader.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::client::live {
namespace {

absl::Status TooLong() {
  return absl::InvalidArgumentError(
      absl::StrCat("expected a line of at most ", kMaxLineBytes, " bytes, got more"));
}

class DescriptorReader final : public LineReader {
 public:
  explicit DescriptorReader(int descriptor)
      : descriptor_(descriptor), stop_(eventfd(0, EFD_CLOEXEC)) {}
  DescriptorReader(const DescriptorReader&) = delete;
  DescriptorReader& operator=(const DescriptorReader&) = delete;
  ~DescriptorReader() override { close(stop_); }

  absl::StatusOr<std::optional<std::string>> Next() override {
    for (;;) {
      const std::size_t end = buffer_.find('\n', searched_);
      if (end != std::string::npos) return Take(end, end + 1);
      searched_ = buffer_.size();
      if (buffer_.size() > kMaxLineBytes) return TooLong();
      if (!Read()) break;
    }
    if (stopped_ || buffer_.empty()) return std::nullopt;
    return Take(buffer_.size(), buffer_.size());  // the last line has no end
  }

  void Stop() override {
    const uint64_t one = 1;
    (void)!write(stop_, &one, sizeof(one));
  }

 private:
  std::optional<std::string> Take(std::size_t length, std::size_t taken) {
    std::string line = buffer_.substr(0, length);
    buffer_.erase(0, taken);
    searched_ = 0;
    return line;
  }

  // Returns false at the end of the input, and after Stop.
  bool Read() {
    for (;;) {
      pollfd files[] = {{descriptor_, POLLIN, 0}, {stop_, POLLIN, 0}};
      if (poll(files, 2, -1) < 0) continue;  // a signal
      if ((files[1].revents & POLLIN) != 0) {
        stopped_ = true;
        return false;
      }
      char block[1 << 16];
      const ssize_t count = read(descriptor_, block, sizeof(block));
      if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (count <= 0) return false;
      buffer_.append(block, static_cast<std::size_t>(count));
      return true;
    }
  }

  const int descriptor_;
  const int stop_;
  std::string buffer_;
  std::size_t searched_ = 0;  // the buffer's bytes before this one hold no end of a line
  bool stopped_ = false;
};

class StreamReader final : public LineReader {
 public:
  explicit StreamReader(std::istream& in) : in_(in) {}

  absl::StatusOr<std::optional<std::string>> Next() override {
    std::string line;
    if (stopped_ || !std::getline(in_, line)) return std::nullopt;
    if (line.size() > kMaxLineBytes) return TooLong();
    return line;
  }
  void Stop() override { stopped_ = true; }

 private:
  std::istream& in_;
  std::atomic<bool> stopped_{false};
};

}  // namespace

std::unique_ptr<LineReader> ReadLinesOf(int descriptor) {
  return std::make_unique<DescriptorReader>(descriptor);
}

std::unique_ptr<LineReader> ReadLinesOf(std::istream& in) {
  return std::make_unique<StreamReader>(in);
}

}  // namespace duet::client::live
