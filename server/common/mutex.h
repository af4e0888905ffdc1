#ifndef DUET_SERVER_COMMON_MUTEX_H_
#define DUET_SERVER_COMMON_MUTEX_H_

#include <chrono>
#include <condition_variable>
#include <mutex>

// Clang's -Wthread-safety checks these; other compilers ignore them.
#if defined(__clang__)
#define DUET_THREAD_ANNOTATION(x) __attribute__((x))
#else
#define DUET_THREAD_ANNOTATION(x)
#endif

#define DUET_CAPABILITY(x) DUET_THREAD_ANNOTATION(capability(x))
#define DUET_SCOPED_CAPABILITY DUET_THREAD_ANNOTATION(scoped_lockable)
#define DUET_GUARDED_BY(x) DUET_THREAD_ANNOTATION(guarded_by(x))
#define DUET_REQUIRES(...) DUET_THREAD_ANNOTATION(requires_capability(__VA_ARGS__))
#define DUET_EXCLUDES(...) DUET_THREAD_ANNOTATION(locks_excluded(__VA_ARGS__))
#define DUET_ACQUIRE(...) DUET_THREAD_ANNOTATION(acquire_capability(__VA_ARGS__))
#define DUET_RELEASE(...) DUET_THREAD_ANNOTATION(release_capability(__VA_ARGS__))

namespace duet::server::common {

// std::mutex with thread-safety annotations. The server's threaded parts use it rather than
// absl::Mutex because ThreadSanitizer understands it in a distribution's uninstrumented libraries.
class DUET_CAPABILITY("mutex") Mutex {
 public:
  void Lock() DUET_ACQUIRE() { mutex_.lock(); }
  void Unlock() DUET_RELEASE() { mutex_.unlock(); }

 private:
  friend class CondVar;
  std::mutex mutex_;
};

// Holds a Mutex for a scope.
class DUET_SCOPED_CAPABILITY MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) DUET_ACQUIRE(mutex) : mutex_(mutex) { mutex_.Lock(); }
  ~MutexLock() DUET_RELEASE() { mutex_.Unlock(); }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

 private:
  Mutex& mutex_;
};

// A condition variable for Mutex. Callers loop over their condition.
class CondVar {
 public:
  void Wait(Mutex& mutex) DUET_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    condition_.wait(lock);
    lock.release();
  }
  // Returns false if `end` was reached first.
  bool WaitUntil(Mutex& mutex, std::chrono::steady_clock::time_point end) DUET_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    const std::cv_status status = condition_.wait_until(lock, end);
    lock.release();
    return status == std::cv_status::no_timeout;
  }
  void NotifyOne() { condition_.notify_one(); }
  void NotifyAll() { condition_.notify_all(); }

 private:
  std::condition_variable condition_;
};

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_MUTEX_H_
