#ifndef DUET_SERVER_CONFIG_MEMORY_PLAN_H_
#define DUET_SERVER_CONFIG_MEMORY_PLAN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "duet/v1/server_config.pb.h"
#include "server/config/server_options.h"

namespace duet::server::config {

// The most memory, in bytes, that the server needs for what its settings let in.
// docs/costs.md#memory derives every term from measurements.
struct MemoryNeed {
  std::uint64_t program = 0;    // code, models, the workers, a reload of the models
  std::uint64_t calls = 0;      // windows and unread frames of max_calls calls
  std::uint64_t transport = 0;  // requests being received
  std::uint64_t held = 0;       // requests of calls being answered
  std::uint64_t parsing = 0;    // one request of the largest size

  std::uint64_t total() const { return program + calls + transport + held + parsing; }
};

MemoryNeed NeedOf(const ServerOptions& options);

// Sets the limits that `config` leaves open so that NeedOf(*options) fits into
// options->memory_limit_bytes: max_calls and max_request_bytes, which shrink only where there is
// little memory; max_transport_bytes and max_held_bytes, which get the rest. They are never below
// what one call needs, even where that does not fit. Uses workers.
void FitCallsToMemory(const v1::ServerConfig& config, ServerOptions* options);
// The second half, once max_calls and max_request_bytes are settled.
void FitBytesToMemory(const v1::ServerConfig& config, ServerOptions* options);

// One line for each way in which the settings do not fit the memory, with the numbers. Empty if
// they fit. `available` is AvailableMemory(); `resident` is what the server holds before it has
// answered a call, 0 if unknown.
std::vector<std::string> MemoryWarnings(const ServerOptions& options, std::uint64_t available,
                                        std::uint64_t resident = 0);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_MEMORY_PLAN_H_
