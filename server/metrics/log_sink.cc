#include "server/metrics/log_sink.h"

#include <utility>

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

// Shared by the writing thread and the threads that log.
class QueuedLogSink::Queue {
 public:
  Queue(std::shared_ptr<LogSink> sink, std::size_t capacity)
      : sink_(std::move(sink)), capacity_(capacity) {}

  bool Push(std::string_view line) {
    {
      common::MutexLock lock(mutex_);
      if (lines_.size() >= capacity_) {
        ++dropped_;
        return false;
      }
      lines_.emplace_back(line);
    }
    changed_.NotifyAll();
    return true;
  }

  std::uint64_t dropped() const { return dropped_; }

  // Runs on the writing thread until the queue is closed and empty.
  void Run() {
    std::vector<std::string> lines;
    while (Next(&lines)) {
      for (const std::string& line : lines) {
        if (!sink_->Write(line)) ++dropped_;
      }
    }
    common::MutexLock lock(mutex_);
    finished_ = true;
    changed_.NotifyAll();
  }

  // Makes Run return. Returns false if it is still stuck in the sink after `patience`.
  bool Close(std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    common::MutexLock lock(mutex_);
    closed_ = true;
    changed_.NotifyAll();
    while (!finished_ && changed_.WaitUntil(mutex_, end)) {
    }
    return finished_;
  }

 private:
  // Waits for lines and takes all of them. Returns false if the queue is closed and empty.
  bool Next(std::vector<std::string>* lines) {
    common::MutexLock lock(mutex_);
    while (lines_.empty() && !closed_) changed_.Wait(mutex_);
    *lines = std::exchange(lines_, {});
    return !lines->empty();
  }

  const std::shared_ptr<LogSink> sink_;
  const std::size_t capacity_;
  std::atomic<std::uint64_t> dropped_{0};
  common::Mutex mutex_;
  common::CondVar changed_;
  std::vector<std::string> lines_ DUET_GUARDED_BY(mutex_);
  bool closed_ DUET_GUARDED_BY(mutex_) = false;
  bool finished_ DUET_GUARDED_BY(mutex_) = false;
};

QueuedLogSink::QueuedLogSink(std::shared_ptr<LogSink> sink, std::size_t capacity,
                             std::chrono::milliseconds patience)
    : queue_(std::make_shared<Queue>(std::move(sink), capacity)),
      patience_(patience),
      writer_([queue = queue_] { queue->Run(); }) {}

QueuedLogSink::~QueuedLogSink() {
  if (queue_->Close(patience_)) {
    writer_.join();
  } else {
    writer_.detach();
  }
}

bool QueuedLogSink::Write(std::string_view line) { return queue_->Push(line); }

std::uint64_t QueuedLogSink::dropped_lines() const { return queue_->dropped(); }

bool CallLogFilter::LogRefusal(int code, double now) {
  common::MutexLock lock(mutex_);
  Second& second = seconds_.at(static_cast<std::size_t>(code));
  // A clock that was set back begins a new second as well.
  if (now < second.begin || now >= second.begin + 1) {
    second.begin = now;
    second.logged = 0;
  }
  const bool log = second.logged < refusals_per_second_;
  if (log) {
    ++second.logged;
  } else {
    ++second.unlogged;
  }
  return log;
}

std::vector<CallLogFilter::Unlogged> CallLogFilter::TakeUnlogged() {
  common::MutexLock lock(mutex_);
  std::vector<Unlogged> taken;
  for (std::size_t code = 0; code < kCodes; ++code) {
    const std::uint64_t calls = std::exchange(seconds_[code].unlogged, 0);
    if (calls > 0) taken.push_back({static_cast<int>(code), calls});
  }
  return taken;
}

}  // namespace duet::server::metrics
