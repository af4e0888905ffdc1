#include "server/metrics/log_sink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdio.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "server/common/mutex.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::metrics {
namespace {

using test::ReadTestFile;
using test::TemporaryFolder;

// A disk with room for a given number of bytes.
class Disk {
 public:
  explicit Disk(std::size_t room) : room_(room) {
    const cookie_io_functions_t functions = {nullptr, &Disk::Write, nullptr, nullptr};
    stream_.reset(fopencookie(this, "w", functions));
  }
  std::FILE* stream() { return stream_.get(); }
  void MakeRoom(std::size_t bytes) { room_ += bytes; }
  const std::string& text() const { return text_; }

 private:
  struct Close {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };

  static ssize_t Write(void* self, const char* bytes, std::size_t count) {
    Disk& disk = *static_cast<Disk*>(self);
    const std::size_t taken = std::min(count, disk.room_);
    disk.text_.append(bytes, taken);
    disk.room_ -= taken;
    if (taken == 0) errno = ENOSPC;
    return static_cast<ssize_t>(taken);
  }

  std::size_t room_;
  std::string text_;
  std::unique_ptr<std::FILE, Close> stream_;
};

TEST(StreamLogSinkTest, LinesOfManyThreadsStayWhole) {
  TemporaryFolder folder;
  const std::string path = (folder / "log").string();
  std::FILE* file = std::fopen(path.c_str(), "w");
  StreamLogSink sink(file);
  std::vector<std::thread> writers;
  for (char c = 'a'; c < 'e'; ++c) {
    writers.emplace_back([&sink, c] {
      for (int i = 0; i < 200; ++i) sink.Write(std::string(300, c));
    });
  }
  for (std::thread& writer : writers) writer.join();
  std::fclose(file);
  const std::string text = ReadTestFile(folder / "log");
  ASSERT_EQ(text.size(), 4u * 200u * 301u);
  for (std::size_t line = 0; line < text.size(); line += 301) {
    EXPECT_EQ(text.substr(line, 301), std::string(300, text[line]) + "\n");
  }
}

TEST(StreamLogSinkTest, StartsANewLineAfterAPartlyWrittenOne) {
  Disk disk(6);
  StreamLogSink sink(disk.stream());
  EXPECT_TRUE(sink.Write("one"));
  EXPECT_FALSE(sink.Write("two"));
  EXPECT_FALSE(sink.Write("three"));
  disk.MakeRoom(1);
  EXPECT_FALSE(sink.Write("four")) << "room for what ends the torn line alone";
  EXPECT_EQ(sink.dropped_lines(), 3u);
  disk.MakeRoom(100);
  EXPECT_TRUE(sink.Write("five"));
  EXPECT_TRUE(sink.Write("six"));
  EXPECT_EQ(disk.text(), "one\ntw\nfive\nsix\n");
}

// A sink that the test blocks and fills: it accepts no line until it is opened, and loses the lines
// that arrive while it is full.
//
// Threads: safe to call concurrently.
class PuppetSink final : public LogSink {
 public:
  bool Write(std::string_view line) override {
    common::MutexLock lock(mutex_);
    ++begun_;
    changed_.NotifyAll();
    while (!open_) changed_.Wait(mutex_);
    if (full_) return false;
    lines_.emplace_back(line);
    changed_.NotifyAll();
    return true;
  }
  void Open() {
    common::MutexLock lock(mutex_);
    open_ = true;
    changed_.NotifyAll();
  }
  void SetFull(bool full) {
    common::MutexLock lock(mutex_);
    full_ = full;
  }
  void WaitUntilBegun(int writes) {
    common::MutexLock lock(mutex_);
    while (begun_ < writes) changed_.Wait(mutex_);
  }
  // Waits until that many lines were accepted.
  void WaitFor(std::size_t lines) {
    common::MutexLock lock(mutex_);
    while (lines_.size() < lines) changed_.Wait(mutex_);
  }
  std::vector<std::string> lines() const {
    common::MutexLock lock(mutex_);
    return lines_;
  }

 private:
  mutable common::Mutex mutex_;
  common::CondVar changed_;
  bool open_ DUET_GUARDED_BY(mutex_) = false;
  bool full_ DUET_GUARDED_BY(mutex_) = false;
  int begun_ DUET_GUARDED_BY(mutex_) = 0;
  std::vector<std::string> lines_ DUET_GUARDED_BY(mutex_);
};

constexpr std::chrono::hours kPatience(1);

TEST(QueuedLogSinkTest, WriteDoesNotBlockOnAStuckSinkAndDroppedLinesAreCounted) {
  const auto sink = std::make_shared<PuppetSink>();
  {
    QueuedLogSink log(sink, 2, kPatience);
    log.Write("stuck");
    sink->WaitUntilBegun(1);
    for (const char* line : {"a", "b", "lost", "lost"}) log.Write(line);  // returns each time
    EXPECT_EQ(log.dropped_lines(), 2u);
    EXPECT_THAT(sink->lines(), IsEmpty());
    sink->Open();
    sink->WaitFor(3);
    log.Write("c");
    EXPECT_EQ(log.dropped_lines(), 2u);
  }
  EXPECT_THAT(sink->lines(), ElementsAre("stuck", "a", "b", "c"));
}

TEST(QueuedLogSinkTest, CountsLinesThatTheSinkLoses) {
  const auto sink = std::make_shared<PuppetSink>();
  sink->Open();
  sink->SetFull(true);
  std::uint64_t dropped = 0;
  {
    QueuedLogSink log(sink, 8, kPatience);
    log.Write("lost");
    log.Write("lost too");
    sink->WaitUntilBegun(2);
    while (log.dropped_lines() < 2) std::this_thread::yield();
    sink->SetFull(false);
    log.Write("a");
    sink->WaitFor(1);
    dropped = log.dropped_lines();
  }
  EXPECT_THAT(sink->lines(), ElementsAre("a"));
  EXPECT_EQ(dropped, 2u);
}

TEST(QueuedLogSinkTest, DestructorWritesTheRemainingLines) {
  const auto sink = std::make_shared<PuppetSink>();
  std::thread opener;
  {
    QueuedLogSink log(sink, 8, kPatience);
    for (const char* line : {"a", "b", "c"}) log.Write(line);
    sink->WaitUntilBegun(1);
    opener = std::thread([&sink] { sink->Open(); });
  }
  EXPECT_THAT(sink->lines(), ElementsAre("a", "b", "c"));
  opener.join();
}

TEST(QueuedLogSinkTest, DestructorGivesUpOnAStuckSink) {
  const auto sink = std::make_shared<PuppetSink>();
  {
    QueuedLogSink log(sink, 8, std::chrono::milliseconds(0));
    log.Write("stuck");
    sink->WaitUntilBegun(1);
  }
  EXPECT_THAT(sink->lines(), IsEmpty());
  sink->Open();  // its thread still exists and ends now
  sink->WaitFor(1);
  EXPECT_THAT(sink->lines(), ElementsAre("stuck"));
}

TEST(QueuedLogSinkTest, KeepsEveryLineOfManyThreads) {
  const auto sink = std::make_shared<PuppetSink>();
  sink->Open();
  std::uint64_t dropped = 0;
  {
    QueuedLogSink log(sink, 16, kPatience);
    std::vector<std::thread> writers;
    for (char c = 'a'; c < 'e'; ++c) {
      writers.emplace_back([&log, c] {
        for (int i = 0; i < 200; ++i) log.Write(std::string(1, c));
      });
    }
    for (std::thread& writer : writers) writer.join();
    dropped = log.dropped_lines();
  }
  EXPECT_EQ(sink->lines().size() + dropped, 800u);
}

constexpr int kFull = 8;  // RESOURCE_EXHAUSTED
constexpr int kWho = 16;  // UNAUTHENTICATED

TEST(CallLogFilterTest, LogsTheFirstRejectionsOfASecondAndCountsTheRest) {
  CallLogFilter filter(2);
  EXPECT_TRUE(filter.LogRefusal(kFull, 100.0));
  EXPECT_TRUE(filter.LogRefusal(kFull, 100.5));
  EXPECT_FALSE(filter.LogRefusal(kFull, 100.6));
  EXPECT_FALSE(filter.LogRefusal(kFull, 100.9));
  EXPECT_TRUE(filter.LogRefusal(kWho, 100.9)) << "each code has its own limit";
  EXPECT_TRUE(filter.LogRefusal(kFull, 101.0));
  EXPECT_TRUE(filter.LogRefusal(kFull, 10)) << "after the clock was set back";
  const std::vector<CallLogFilter::Unlogged> unlogged = filter.TakeUnlogged();
  ASSERT_EQ(unlogged.size(), 1u);
  EXPECT_EQ(unlogged[0].code, kFull);
  EXPECT_EQ(unlogged[0].calls, 2u);
  EXPECT_TRUE(filter.TakeUnlogged().empty());
}

TEST(CallLogFilterTest, EveryCallIsLoggedOrCounted) {
  CallLogFilter filter(10);
  std::atomic<int> logged{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 500; ++i) logged += filter.LogRefusal(kFull, 7) ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(logged.load(), 10);
  EXPECT_EQ(filter.TakeUnlogged().at(0).calls, 1990u);
}

}  // namespace
}  // namespace duet::server::metrics
