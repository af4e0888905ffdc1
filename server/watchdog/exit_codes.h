#ifndef DUET_SERVER_WATCHDOG_EXIT_CODES_H_
#define DUET_SERVER_WATCHDOG_EXIT_CODES_H_

namespace duet::server::watchdog {

// Exit codes of duet-server.
inline constexpr int kExitStopped = 0;  // drained after SIGTERM or SIGINT, or nothing to report
inline constexpr int kExitFailed = 1;   // a file, an address or a model that settings name is wrong
inline constexpr int kExitUsage = 2;    // a flag or the configuration file is wrong
inline constexpr int kExitStuck = 3;    // a thread made no progress for watchdog_seconds
inline constexpr int kExitLate = 4;     // asked to stop, and did not end in time

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_EXIT_CODES_H_
