#ifndef DUET_CLIENT_CAPTURE_OSC_H_
#define DUET_CLIENT_CAPTURE_OSC_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

// Open Sound Control 1.0, as far as motion protocols use it.

namespace duet::client::capture {

inline constexpr int kMaxOscDepth = 4;  // of bundles in bundles
inline constexpr std::size_t kMaxOscArguments = 64;

// A message whose arguments are not read yet. Refers to the datagram.
struct OscMessage {
  absl::string_view address;
  absl::string_view types;  // without the comma: "sfffffff"
  absl::string_view data;
};

// Visits the messages of a datagram, which is one message or a bundle, in order. Stops at the first
// error and returns it: that of `visit`, or INVALID_ARGUMENT for a malformed datagram.
absl::Status ForEachOscMessage(absl::string_view datagram,
                               absl::FunctionRef<absl::Status(const OscMessage&)> visit);

// An argument of type i, h, f, d, T, F (a number) or s (text).
struct OscArgument {
  bool is_text = false;
  double number = 0;
  absl::string_view text;  // in the datagram
};
// Errors: INVALID_ARGUMENT naming the address if there are more than kMaxOscArguments arguments,
// types other than these, or fewer bytes than the types need.
absl::StatusOr<std::vector<OscArgument>> ReadOscArguments(const OscMessage& message);

// Writes one bundle, to be executed immediately.
//
//   OscBundle bundle;
//   bundle.Begin("/VMC/Ext/T", "f");
//   bundle.Add(1.5f);
//   socket.Send(bundle.bytes());
class OscBundle {
 public:
  OscBundle();

  // Begins a message, whose arguments must follow in the order of `types` ("i", "f", "s").
  void Begin(absl::string_view address, absl::string_view types);
  void Add(int value);
  void Add(float value);
  void Add(absl::string_view text);

  bool empty() const;
  std::size_t size() const { return bytes_.size(); }
  // Ends the last message.
  const std::string& bytes();

 private:
  void EndMessage();
  void AddText(absl::string_view text);
  void AddBig32(unsigned value);

  std::string bytes_;
  std::size_t message_ = 0;  // where the size of the open message stands; 0: none is open
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_OSC_H_
