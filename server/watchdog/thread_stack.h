#ifndef DUET_SERVER_WATCHDOG_THREAD_STACK_H_
#define DUET_SERVER_WATCHDOG_THREAD_STACK_H_

#include <sys/types.h>

#include <chrono>
#include <cstddef>

namespace duet::server::watchdog {

// Writes the stack of a thread of this process, innermost frame first, each as file+0xoffset for
// addr2line: "duet-server+0x1a2b libc.so.6+0x89e3". The text is empty if the thread does not
// respond in time, for example because a debugger has stopped it. Interrupts the thread with
// SIGUSR2: only for a process that is about to exit.
//
// Allocates no memory after PrepareThreadStacks; naming the frames takes the dynamic linker's lock.
void WriteThreadStack(pid_t thread_id, std::chrono::milliseconds patience, char* text,
                      std::size_t size);

// Loads what WriteThreadStack needs. Call it while the process is healthy.
void PrepareThreadStacks();

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_THREAD_STACK_H_
