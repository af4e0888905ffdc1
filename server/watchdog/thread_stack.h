#ifndef DUET_SERVER_WATCHDOG_THREAD_STACK_H_
#define DUET_SERVER_WATCHDOG_THREAD_STACK_H_

#include <sys/types.h>

#include <chrono>
#include <cstddef>

namespace duet::server::watchdog {

// Writes where a thread of this process is, innermost frame first, each as file+0xoffset, which
// addr2line reads: "duet-server+0x1a2b libc.so.6+0x89e3". Empty where the thread does not answer in
// time, as one that a debugger has stopped. Interrupts the thread by SIGUSR2: only for a process
// that is about to end.
//
// Takes no memory once PrepareThreadStacks was called; naming the frames takes the dynamic linker's
// lock.
void WriteThreadStack(pid_t thread_id, std::chrono::milliseconds patience, char* text,
                      std::size_t size);

// Loads what WriteThreadStack needs. Call while all is well.
void PrepareThreadStacks();

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_THREAD_STACK_H_
