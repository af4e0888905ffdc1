#ifndef DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
#define DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_

#include <google/protobuf/message.h>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::messages {

// How people write a protobuf message in a file.
enum class MessageSyntax { kTextFormat, kJson };

// Replaces `message` by what `text` says. Strict: unknown fields are refused. Errors:
// INVALID_ARGUMENT, with line and column where the syntax tells them.
absl::Status ParseMessage(absl::string_view text, MessageSyntax syntax,
                          google::protobuf::Message* message);

}  // namespace duet::messages

#endif  // DUET_MODEL_MESSAGES_MESSAGE_TEXT_H_
