#ifndef DUET_SERVER_BATCHING_PRIORITY_H_
#define DUET_SERVER_BATCHING_PRIORITY_H_

#include <cstddef>
#include <string_view>

namespace duet::server::batching {

// How urgent a call is. Bulk windows start after waiting interactive windows; see Decide.
enum class Priority { kInteractive, kBulk };

// Returns the name in metrics and logs.
constexpr std::string_view PriorityName(Priority priority) {
  return priority == Priority::kBulk ? "bulk" : "interactive";
}

// Returns the part of a limit that calls of a priority may use: all of it for interactive calls,
// three quarters for bulk calls, so that a quarter remains free for interactive calls.
constexpr std::size_t ShareOf(std::size_t limit, Priority priority) {
  return priority == Priority::kBulk ? limit - limit / 4 : limit;
}

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_PRIORITY_H_
