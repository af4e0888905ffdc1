#include "server/common/trace_context.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace duet::server::common {
namespace {

// 00-<32 hex>-<16 hex>-<2 hex>
constexpr std::size_t kTraceAt = 3, kTraceSize = 32, kParentAt = 36, kParentSize = 16,
                      kFlagsAt = 53, kSize = 55;

bool IsLowerHex(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

bool IsIdentifier(std::string_view text) {
  return IsLowerHex(text) && text.find_first_not_of('0') != std::string_view::npos;
}

int HexDigit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

std::uint64_t Random() {
  thread_local std::mt19937_64 generator = [] {
    std::random_device device;
    std::seed_seq seed{device(), device(), device(), device(), device(), device()};
    return std::mt19937_64(seed);
  }();
  // Zero is not a valid identifier.
  return std::max<std::uint64_t>(generator(), 1);
}

std::string ToHex(std::uint64_t value) {
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, value >>= 4) {
    *digit = "0123456789abcdef"[value & 15];
  }
  return text;
}

}  // namespace

std::optional<TraceContext> ContinueTrace(std::string_view traceparent) {
  if (traceparent.size() != kSize || traceparent.substr(0, kTraceAt) != "00-" ||
      traceparent[kParentAt - 1] != '-' || traceparent[kFlagsAt - 1] != '-') {
    return std::nullopt;
  }
  const std::string_view trace = traceparent.substr(kTraceAt, kTraceSize);
  const std::string_view parent = traceparent.substr(kParentAt, kParentSize);
  const std::string_view flags = traceparent.substr(kFlagsAt);
  if (!IsIdentifier(trace) || !IsIdentifier(parent) || !IsLowerHex(flags)) return std::nullopt;
  return TraceContext{std::string(trace), ToHex(Random()), std::string(parent),
                      (HexDigit(flags.back()) & 1) != 0};
}

TraceContext BeginTrace(double ratio) {
  const std::uint64_t high = Random();
  const std::uint64_t low = Random();
  // 53 bits, which a double holds exactly.
  const bool sampled = std::ldexp(static_cast<double>(low >> 11), -53) < ratio;
  return {ToHex(high) + ToHex(low), ToHex(Random()), "", sampled};
}

std::string Traceparent(const TraceContext& context) {
  if (context.trace_id.empty()) return "";
  return "00-" + context.trace_id + "-" + context.span_id + (context.sampled ? "-01" : "-00");
}

}  // namespace duet::server::common
