#include "server/watchdog/thread_stack.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace duet::server::watchdog {
namespace {

constexpr int kSignal = SIGUSR2;
constexpr int kMaxFrames = 32;
constexpr int kOwnFrames = 2;  // the handler and its caller

void* frames[kMaxFrames];
std::atomic<int> frame_count{0};
std::atomic<pid_t> asked{0};  // the thread whose stack is requested

void Answer(int) {
  const int error = errno;
  if (asked.load(std::memory_order_acquire) == gettid()) {
    frame_count.store(backtrace(frames, kMaxFrames), std::memory_order_release);
  }
  errno = error;
}

const char* FileName(const char* path) {
  const char* const slash = std::strrchr(path, '/');
  return slash == nullptr ? path : slash + 1;
}

// Returns the number of characters written.
std::size_t WriteFrame(void* address, char* text, std::size_t size) {
  Dl_info info = {};
  const bool known = dladdr(address, &info) != 0 && info.dli_fname != nullptr;
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  const auto base = known ? reinterpret_cast<std::uintptr_t>(info.dli_fbase) : 0;
  const int length = std::snprintf(text, size, "%s+0x%zx ", known ? FileName(info.dli_fname) : "?",
                                   static_cast<std::size_t>(at - base));
  return length > 0 && static_cast<std::size_t>(length) < size ? static_cast<std::size_t>(length)
                                                               : 0;
}

}  // namespace

void PrepareThreadStacks() {
  void* frame = nullptr;
  backtrace(&frame, 1);
}

void WriteThreadStack(pid_t thread_id, std::chrono::milliseconds patience, char* text,
                      std::size_t size) {
  text[0] = '\0';
  struct sigaction action = {};
  action.sa_handler = Answer;
  action.sa_flags = SA_RESTART;
  sigaction(kSignal, &action, nullptr);
  frame_count = 0;
  asked.store(thread_id, std::memory_order_release);
  if (syscall(SYS_tgkill, getpid(), thread_id, kSignal) != 0) return;
  const auto end = std::chrono::steady_clock::now() + patience;
  while (frame_count.load(std::memory_order_acquire) == 0) {
    if (std::chrono::steady_clock::now() >= end) {
      asked = 0;
      return;
    }
    const timespec moment = {0, 1'000'000};
    nanosleep(&moment, nullptr);
  }
  std::size_t written = 0;
  const int count = frame_count;
  for (int i = kOwnFrames; i < count; ++i) {
    const std::size_t length = WriteFrame(frames[i], text + written, size - written);
    if (length == 0) break;
    written += length;
  }
  if (written > 0) --written;  // the last space
  text[written] = '\0';
}

}  // namespace duet::server::watchdog
