#ifndef DUET_TESTS_CLIENT_SUPPORT_TEXT_INPUT_H_
#define DUET_TESTS_CLIENT_SUPPORT_TEXT_INPUT_H_

#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "gtest/gtest.h"

namespace duet::test {

// A text as an input that programs read, such as standard input.
class TextInput {
 public:
  explicit TextInput(const std::string& text) : descriptor_(memfd_create("input", MFD_CLOEXEC)) {
    EXPECT_EQ(write(descriptor_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    EXPECT_EQ(lseek(descriptor_, 0, SEEK_SET), 0);
  }
  TextInput(const TextInput&) = delete;
  TextInput& operator=(const TextInput&) = delete;
  ~TextInput() { close(descriptor_); }
  int descriptor() const { return descriptor_; }

 private:
  const int descriptor_;
};

// A pipe whose writer a test closes.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(pipe(ends_), 0); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() { close(ends_[0]); }
  void Write(const std::string& text) const {
    EXPECT_EQ(write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void CloseWriter() const { close(ends_[1]); }
  int reader() const { return ends_[0]; }

 private:
  int ends_[2] = {-1, -1};
};

}  // namespace duet::test

#endif  // DUET_TESTS_CLIENT_SUPPORT_TEXT_INPUT_H_
