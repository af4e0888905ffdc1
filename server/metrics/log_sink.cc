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
  Queue(std::shared_ptr<LogSink> sink, Options options)
      : sink_(std::move(sink)), options_(std::move(options)) {}

  bool Push(std::string_view line) {
    {
      common::MutexLock lock(mutex_);
      if (lines_.size() >= options_.capacity) {
        ++dropped_;
        return false;
      }
      lines_.emplace_back(line);
    }
    changed_.NotifyAll();
    return true;
  }

  std::uint64_t dropped() const {
    common::MutexLock lock(mutex_);
    return dropped_;
  }

  // Runs on the writing thread until the queue is closed and empty.
  void Run() {
    Batch batch;
    std::uint64_t reported = 0;  // lost lines that notices have reported
    while (Next(&batch)) {
      std::uint64_t lost = 0;
      for (const std::string& line : batch.lines) lost += sink_->Write(line) ? 0 : 1;
      CountLost(lost);
      // Lines are dropped only while the queue is full, so they followed the lines of the batch. If
      // the notice is lost as well, the next one reports all lines.
      const std::uint64_t unreported = batch.dropped + lost - reported;
      if (unreported > 0 && sink_->Write(options_.drop_notice(unreported))) reported += unreported;
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
  struct Batch {
    std::vector<std::string> lines;
    std::uint64_t dropped = 0;  // lines lost since the start, when the batch was taken
  };

  // Waits for lines and takes all of them. Returns false if the queue is closed and empty.
  bool Next(Batch* batch) {
    common::MutexLock lock(mutex_);
    while (lines_.empty() && !closed_) changed_.Wait(mutex_);
    batch->lines = std::exchange(lines_, {});
    batch->dropped = dropped_;
    return !batch->lines.empty();
  }

  void CountLost(std::uint64_t lines) {
    common::MutexLock lock(mutex_);
    dropped_ += lines;
  }

  const std::shared_ptr<LogSink> sink_;
  const Options options_;
  mutable common::Mutex mutex_;
  common::CondVar changed_;
  std::vector<std::string> lines_ DUET_GUARDED_BY(mutex_);
  std::uint64_t dropped_ DUET_GUARDED_BY(mutex_) = 0;
  bool closed_ DUET_GUARDED_BY(mutex_) = false;
  bool finished_ DUET_GUARDED_BY(mutex_) = false;
};

QueuedLogSink::QueuedLogSink(std::shared_ptr<LogSink> sink, const Options& options)
    : queue_(std::make_shared<Queue>(std::move(sink), options)),
      patience_(options.patience),
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
