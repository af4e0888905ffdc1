#ifndef DUET_SERVER_BATCHING_PRIORITY_H_
#define DUET_SERVER_BATCHING_PRIORITY_H_

#include <cstddef>
#include <string_view>

namespace duet::server::batching {

// How urgent a call is: every waiting interactive window starts before any bulk one.
enum class Priority { kInteractive, kBulk };

// The name in metrics and logs.
constexpr std::string_view PriorityName(Priority priority) {
  return priority == Priority::kBulk ? "bulk" : "interactive";
}

// The part of a limit that work of a priority may fill: interactive work all of it, bulk work three
// quarters, so that the last quarter stays free for interactive calls.
constexpr std::size_t ShareOf(std::size_t limit, Priority priority) {
  return priority == Priority::kBulk ? limit - limit / 4 : limit;
}

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_PRIORITY_H_
