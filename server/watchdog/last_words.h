#ifndef DUET_SERVER_WATCHDOG_LAST_WORDS_H_
#define DUET_SERVER_WATCHDOG_LAST_WORDS_H_

#include <cstddef>
#include <cstdint>

namespace duet::server::watchdog {

// What a process does that cannot trust its heap, its locks or its log any more: write some lines
// and end.

// One line of the log (json_log.h, text_log_sink.h), made without taking memory.
//
//   LastLine line(/*text=*/false, "thread_stuck");
//   line.Add("thread", "worker");
//   line.Write(STDERR_FILENO);
class LastLine {
 public:
  // `event`, keys and texts are plain ASCII without quotes or backslashes. What does not fit is
  // left out.
  LastLine(bool text, const char* event);
  void Add(const char* key, const char* value);
  void Add(const char* key, std::int64_t value);
  void Add(const char* key, double seconds);

  // Ends the line and writes it to a descriptor; waits for its reader. Call once.
  void Write(int descriptor);

  const char* c_str() const { return bytes_; }

 private:
  void Append(const char* format, ...) __attribute__((format(printf, 2, 3)));

  const bool text_;
  std::size_t size_ = 0;
  bool is_full_ = false;
  // What a pipe takes at once, so that no other line comes in between.
  char bytes_[4096];
};

// From now on the process ends with `exit_code` in `seconds`, even if the calling thread waits for
// the reader of the log, or for a lock, for ever. Uses SIGALRM, which no thread may block for that.
void EndWithin(unsigned seconds, int exit_code);

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_LAST_WORDS_H_
