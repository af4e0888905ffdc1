#include "server/metrics/log_sink.h"

#include <gtest/gtest.h>
#include <stdio.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <memory>
#include <string>
#include <thread>
#include <vector>

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

TEST(StreamLogSinkTest, WritesLines) {
  Disk disk(100);
  StreamLogSink sink(disk.stream());
  EXPECT_TRUE(sink.Write("one"));
  EXPECT_EQ(disk.text(), "one\n") << "at once";
  EXPECT_TRUE(sink.Write(""));
  EXPECT_TRUE(sink.Write("two"));
  EXPECT_EQ(disk.text(), "one\n\ntwo\n");
  EXPECT_EQ(sink.dropped_lines(), 0u);
}

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

TEST(StreamLogSinkTest, CountsALineThatDoesNotFit) {
  Disk disk(4);
  StreamLogSink sink(disk.stream());
  EXPECT_TRUE(sink.Write("one"));
  EXPECT_FALSE(sink.Write("two"));
  EXPECT_FALSE(sink.Write("three"));
  EXPECT_EQ(sink.dropped_lines(), 2u);
  disk.MakeRoom(100);
  EXPECT_TRUE(sink.Write("four"));
  EXPECT_EQ(disk.text(), "one\nfour\n") << "nothing of what was lost comes later";
  EXPECT_EQ(sink.dropped_lines(), 2u);
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

TEST(StreamLogSinkTest, LosesEveryLineOnAFullDevice) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> full(std::fopen("/dev/full", "w"),
                                                             &std::fclose);
  ASSERT_NE(full, nullptr);
  StreamLogSink sink(full.get());
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(sink.Write("line"));
  EXPECT_EQ(sink.dropped_lines(), 3u);
}

}  // namespace
}  // namespace duet::server::metrics
