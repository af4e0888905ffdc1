#ifndef DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
#define DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_

#include <google/protobuf/message.h>

#include <map>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::messages {

// A place in a text; line and column count from 1.
struct Place {
  int line = 1;
  int column = 1;
  friend bool operator<(const Place& a, const Place& b) {
    return a.line != b.line ? a.line < b.line : a.column < b.column;
  }
};

// Where a text sets a message's fields, by their names in the schema: "max_calls", and
// "version_labels[0]" for each element of a repeated field.
using FieldPlaces = std::map<std::string, Place>;

// The syntax of a protobuf message in a file.
enum class MessageSyntax { kTextFormat, kJson };

// Replaces `message` by the content of `text`; on an error, by the part that could be read. Rejects
// unknown and repeated fields.
//
// Errors: INVALID_ARGUMENT. The text format reports every unknown field and the first other error,
// one line each: "line 3:5: ...". JSON reports the first error, with the path of its field.
//
// If `places` is not null, it receives the place of each field that a text format sets.
absl::Status ParseMessage(absl::string_view text, MessageSyntax syntax,
                          google::protobuf::Message* message, FieldPlaces* places = nullptr);

}  // namespace duet::messages

#endif  // DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
