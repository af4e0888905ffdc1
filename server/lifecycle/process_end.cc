#include "server/lifecycle/process_end.h"

#include <malloc.h>
#include <poll.h>
#include <semaphore.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <thread>

namespace duet::server::lifecycle {

namespace {

constexpr long kNanoseconds = 1'000'000'000;

timespec ToTimespec(double seconds) {
  const double whole = std::floor(seconds);
  return {static_cast<time_t>(whole), static_cast<long>((seconds - whole) * kNanoseconds)};
}

void Handle(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

// The state of StopSignal, which handlers of signals reach. Lock-free.
std::atomic<int> stops{0};          // not handled yet
std::atomic<bool> reload{false};    // not handled yet
std::atomic<bool> stopping{false};  // a stop has arrived
std::atomic<double> allowed{0};     // seconds from the first stop
std::atomic<LastResort*> late{nullptr};
sem_t arrived;  // posted for each signal

void OnStop(int) {
  const bool again = stopping.exchange(true);
  late.load()->Set(again ? StopSignal::kHurrySeconds : allowed.load());
  ++stops;
  sem_post(&arrived);
}

void OnReload(int) {
  reload = true;
  sem_post(&arrived);
}

bool TakeStop() {
  if (stops == 0) return false;
  --stops;
  return true;
}

}  // namespace

LastResort::LastResort(const std::string& event, const std::string& message, int exit_code)
    : line_(R"({"severity":"ERROR","event":")" + event + R"(","message":")" + message +
            R"(","exit_code":)" + std::to_string(exit_code) + "}\n"),
      exit_code_(exit_code) {
  struct sigaction action = {};
  action.sa_sigaction = End;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGALRM, &action, nullptr);
  sigevent expiry = {};
  expiry.sigev_notify = SIGEV_SIGNAL;
  expiry.sigev_signo = SIGALRM;
  expiry.sigev_value.sival_ptr = this;
  timer_create(CLOCK_MONOTONIC, &expiry, &timer_);
}

LastResort::~LastResort() { timer_delete(timer_); }

void LastResort::Set(double seconds) {
  itimerspec end = {};
  end.it_value = ToTimespec(seconds);
  timer_settime(timer_, 0, &end, nullptr);
}

// A pipe that is full would block the line, and with it the exit.
void LastResort::End(int, siginfo_t* info, void*) {
  const auto* self = static_cast<const LastResort*>(info->si_value.sival_ptr);
  pollfd log = {STDERR_FILENO, POLLOUT, 0};
  if (poll(&log, 1, 0) > 0 && (log.revents & POLLOUT) != 0) {
    // Nothing is left to do about a line that is lost.
    [[maybe_unused]] const ssize_t written =
        write(STDERR_FILENO, self->line_.data(), self->line_.size());
  }
  _exit(self->exit_code_);
}

StopSignal::StopSignal()
    : late_("stopped_late", "asked to stop, and did not end in time; the process ends as it is",
            kExitLate) {
  stops = 0;
  reload = stopping = false;
  allowed = kHurrySeconds;
  late = &late_;
  sem_init(&arrived, /*pshared=*/0, 0);
  for (const int signal : {SIGTERM, SIGINT}) Handle(signal, OnStop);
  Handle(SIGHUP, OnReload);
}

StopSignal::~StopSignal() { Release(); }

// NOLINTNEXTLINE(readability-convert-member-functions-to-static)
void StopSignal::Release() {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) Handle(signal, SIG_DFL);
}

// NOLINTNEXTLINE(readability-convert-member-functions-to-static)
void StopSignal::AllowToStop(double seconds) { allowed = seconds; }

StopSignal::Kind StopSignal::Wait() {
  while (true) {
    if (TakeStop()) return Kind::kStop;
    if (reload.exchange(false)) return Kind::kReload;
    sem_wait(&arrived);
  }
}

// NOLINTNEXTLINE(readability-convert-member-functions-to-static)
bool StopSignal::WaitFor(double seconds) {
  timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  timespec end = ToTimespec(seconds);
  end.tv_sec += now.tv_sec + (end.tv_nsec + now.tv_nsec) / kNanoseconds;
  end.tv_nsec = (end.tv_nsec + now.tv_nsec) % kNanoseconds;
  while (!TakeStop()) {
    if (sem_clockwait(&arrived, CLOCK_MONOTONIC, &end) != 0 && errno == ETIMEDOUT)
      return TakeStop();
  }
  return true;
}

namespace {

// Trimming walks the whole heap; less than this is not worth it.
constexpr std::size_t kWorthIt = std::size_t{1} << 20;

// Blocks of at least this size are mapped individually, and at most this much stays free at the end
// of a heap. Short clips need less, so that they do not request memory from the system.
constexpr int kKeptBytes = 1 << 20;

}  // namespace

void LimitFreeMemory() {
  mallopt(M_MMAP_THRESHOLD, kKeptBytes);
  mallopt(M_TRIM_THRESHOLD, kKeptBytes);
  mallopt(M_ARENA_MAX, 2 * static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

void HeapTrimmer::Look(std::uint64_t received_bytes, std::size_t held_bytes) {
  const bool came = received_bytes != received_bytes_;
  const bool went = held_bytes + kWorthIt <= held_bytes_;
  // Small requests do not change held_bytes_, so that they never add up to a trim.
  if (came || went || held_bytes > held_bytes_) held_bytes_ = held_bytes;
  received_bytes_ = received_bytes;
  if (came || went || once_more_) trim_();
  once_more_ = came || went;
}

}  // namespace duet::server::lifecycle
