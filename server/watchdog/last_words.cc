#include "server/watchdog/last_words.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace duet::server::watchdog {
namespace {

constexpr std::size_t kEnd = 3;  // "}\n" and the terminator

std::atomic<int> alarm_exit_code{0};

void Exit(int) { _exit(alarm_exit_code); }

}  // namespace

LastLine::LastLine(bool text, const char* event) : text_(text) {
  bytes_[0] = '\0';
  timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  tm utc = {};
  gmtime_r(&now.tv_sec, &utc);
  char time[32];
  std::strftime(time, sizeof(time), "%Y-%m-%dT%H:%M:%S", &utc);
  const long microseconds = now.tv_nsec / 1000;
  if (text_) {
    Append("%s.%06ldZ ERROR   %s", time, microseconds, event);
  } else {
    Append(R"({"time":"%s.%06ldZ","severity":"ERROR","event":"%s")", time, microseconds, event);
  }
}

void LastLine::Append(const char* format, ...) {
  if (is_full_) return;
  const std::size_t room = sizeof(bytes_) - kEnd - size_;
  va_list values;
  va_start(values, format);
  const int length = std::vsnprintf(bytes_ + size_, room, format, values);
  va_end(values);
  if (length < 0 || static_cast<std::size_t>(length) >= room) {
    bytes_[size_] = '\0';
    is_full_ = true;
    return;
  }
  size_ += static_cast<std::size_t>(length);
}

void LastLine::Add(const char* key, const char* value) {
  if (text_ && std::strchr(value, ' ') == nullptr) {
    Append(" %s=%s", key, value);
  } else {
    Append(text_ ? R"( %s="%s")" : R"(,"%s":"%s")", key, value);
  }
}

void LastLine::Add(const char* key, std::int64_t value) {
  Append(text_ ? " %s=%" PRId64 : ",\"%s\":%" PRId64, key, value);
}

void LastLine::Add(const char* key, double seconds) {
  Append(text_ ? " %s=%.1f" : ",\"%s\":%.1f", key, seconds);
}

void LastLine::Write(int descriptor) {
  std::memcpy(bytes_ + size_, text_ ? "\n" : "}\n", text_ ? 2 : 3);
  size_ += text_ ? 1 : 2;
  for (std::size_t done = 0; done < size_;) {
    const ssize_t written = write(descriptor, bytes_ + done, size_ - done);
    if (written < 0 && errno != EINTR) return;
    if (written > 0) done += static_cast<std::size_t>(written);
  }
}

void EndWithin(unsigned seconds, int exit_code) {
  alarm_exit_code = exit_code;
  struct sigaction action = {};
  action.sa_handler = Exit;
  sigaction(SIGALRM, &action, nullptr);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGALRM);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  alarm(seconds);
}

}  // namespace duet::server::watchdog
