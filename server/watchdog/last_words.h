#ifndef DUET_SERVER_WATCHDOG_LAST_WORDS_H_
#define DUET_SERVER_WATCHDOG_LAST_WORDS_H_

#include <cstddef>
#include <cstdint>

namespace duet::server::watchdog {

// For a process that can no longer trust its heap, its locks or its log: it writes a few lines and
// exits.

// One line of the log (json_log.h), formatted without allocating memory.
//
//   LastLine line(/*text=*/false, "thread_stuck");
//   line.Add("thread", "worker");
//   line.Write(STDERR_FILENO);
class LastLine {
 public:
  // `event`, keys and texts are plain ASCII without quotes or backslashes. Fields that do not fit
  // are omitted.
  LastLine(bool text, const char* event);
  void Add(const char* key, const char* value);
  void Add(const char* key, std::int64_t value);
  void Add(const char* key, double seconds);

  // Ends the line and writes it to a descriptor. Blocks until the reader takes it. Call once.
  void Write(int descriptor);

  const char* c_str() const { return bytes_; }

 private:
  void Append(const char* format, ...) __attribute__((format(printf, 2, 3)));

  const bool text_;
  std::size_t size_ = 0;
  bool is_full_ = false;
  // The size that a pipe writes atomically, so that no other line is mixed in.
  char bytes_[4096];
};

// Makes the process exit with `exit_code` after `seconds`, even if the calling thread blocks
// forever on the log or on a lock. Uses SIGALRM, which no other use may block.
void EndWithin(unsigned seconds, int exit_code);

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_LAST_WORDS_H_
