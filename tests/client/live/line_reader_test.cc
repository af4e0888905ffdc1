// Lines of an input that may be slow.
#include <unistd.h>

#include <string>
#include <thread>

#include "client/live/json_lines.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/status_matchers.h"

namespace duet::client::live {
namespace {

using test::StatusIs;

using ::testing::HasSubstr;

// A pipe whose ends a test closes.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(pipe(ends_), 0); }
  ~Pipe() {
    CloseWriter();
    close(ends_[0]);
  }
  void Write(const std::string& text) const {
    EXPECT_EQ(write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void CloseWriter() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }
  int reader() const { return ends_[0]; }

 private:
  int ends_[2] = {-1, -1};
};

std::optional<std::string> NextOf(LineReader& lines) {
  const auto line = lines.Next();
  EXPECT_TRUE(line.ok()) << line.status();
  return line.ok() ? *line : std::nullopt;
}

TEST(LineReaderTest, ReadsLinesAsTheyArrive) {
  Pipe pipe;
  LineReader lines(pipe.reader());
  pipe.Write("one\ntw");
  EXPECT_EQ(NextOf(lines), "one");
  pipe.Write("o\n\nthree");
  EXPECT_EQ(NextOf(lines), "two");
  EXPECT_EQ(NextOf(lines), "");
  pipe.CloseWriter();
  EXPECT_EQ(NextOf(lines), "three");  // without an end
  EXPECT_EQ(NextOf(lines), std::nullopt);
}

TEST(LineReaderTest, StopInterruptsAReaderThatWaits) {
  Pipe pipe;
  LineReader lines(pipe.reader());
  pipe.Write("half a li");
  std::thread stopper([&lines] { lines.Stop(); });
  EXPECT_EQ(NextOf(lines), std::nullopt);
  stopper.join();
  EXPECT_EQ(NextOf(lines), std::nullopt);
}

TEST(LineReaderTest, ALineIsNotEndless) {
  Pipe pipe;
  std::thread writer([&pipe] { pipe.Write(std::string(kMaxLineBytes + 100000, 'x')); });
  EXPECT_THAT(LineReader(pipe.reader()).Next(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("at most 1048576 bytes")));
  std::string rest(200000, ' ');
  while (read(pipe.reader(), rest.data(), rest.size()) == static_cast<ssize_t>(rest.size())) {
  }
  writer.join();
}

}  // namespace
}  // namespace duet::client::live
