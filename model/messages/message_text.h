#ifndef DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
#define DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_

#include <google/protobuf/message.h>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/messages/field_places.h"

namespace duet::messages {

// How people write a protobuf message in a file.
enum class MessageSyntax { kTextFormat, kJson };

// Replaces `message` by what `text` says, where it fails by what could be read of it. Strict:
// unknown and repeated fields are refused. Errors: INVALID_ARGUMENT, one line for each thing that
// is wrong, in the order of the file: "line 3:5: ...". Of the text format that is every unknown
// field and the first of all other errors; of JSON every field, or the first error of its syntax.
//
// `places`, where given, receives where the text has each field that it sets.
absl::Status ParseMessage(absl::string_view text, MessageSyntax syntax,
                          google::protobuf::Message* message, FieldPlaces* places = nullptr);

}  // namespace duet::messages

#endif  // DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
