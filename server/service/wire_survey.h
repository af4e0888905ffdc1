#ifndef DUET_SERVER_SERVICE_WIRE_SURVEY_H_
#define DUET_SERVER_SERVICE_WIRE_SURVEY_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>

#include "absl/status/status.h"

namespace duet::server::service {

// Walks the bytes of a message without building anything, and counts what it holds.
//
// A parsed message can be many times as large as its bytes: an empty submessage has two bytes on
// the wire and takes a hundred in memory. So how often a field comes is bounded before the parser
// sees it, far above what any request of use has; how often it may come in a request that is
// answered, the validator says.
//
//   field that comes              at most, in the whole message
//   numbers of a repeated field   no limit: in memory they are no larger than on the wire
//   repeated                      65,536; below another repeated field 262,144
//   any other                     1,024, or as often as the repeated field that it is part of
//   unknown, or of another type   1,024 together
//
// Fails with INVALID_ARGUMENT naming the field and its limit. Bytes that are no message at all are
// the parser's to refuse: OK here.
absl::Status SurveyMessage(google::protobuf::io::ZeroCopyInputStream& bytes,
                           const google::protobuf::Descriptor& type);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_WIRE_SURVEY_H_
