#ifndef DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
#define DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_

#include <google/protobuf/message.h>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/messages/field_places.h"

namespace duet::messages {

// The syntax of a protobuf message in a file.
enum class MessageSyntax { kTextFormat, kJson };

// Replaces `message` by the content of `text`; on an error, by the part that could be read. Rejects
// unknown and repeated fields.
//
// Errors: INVALID_ARGUMENT with one line per error, in the order of the file: "line 3:5: ...". The
// text format reports every unknown field and the first other error. JSON reports every wrong
// field, or the first syntax error.
//
// If `places` is not null, it receives the place of each field that the text sets.
absl::Status ParseMessage(absl::string_view text, MessageSyntax syntax,
                          google::protobuf::Message* message, FieldPlaces* places = nullptr);

}  // namespace duet::messages

#endif  // DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
