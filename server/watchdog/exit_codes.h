#ifndef DUET_SERVER_WATCHDOG_EXIT_CODES_H_
#define DUET_SERVER_WATCHDOG_EXIT_CODES_H_

namespace duet::server::watchdog {

// Exit codes of duet-server.
inline constexpr int kExitStopped = 0;  // drained after SIGTERM or SIGINT, or nothing to report
inline constexpr int kExitFailed = 1;   // a file, address or model that settings name is invalid
inline constexpr int kExitUsage = 2;    // a flag or the configuration file is invalid
inline constexpr int kExitStuck = 3;    // a thread made no progress for watchdog_seconds
inline constexpr int kExitLate = 4;     // did not exit in time after a signal to stop

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_EXIT_CODES_H_
