#ifndef DUET_CLIENT_BATCH_PARSE_RECORD_H_
#define DUET_CLIENT_BATCH_PARSE_RECORD_H_

#include <nlohmann/json.hpp>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// Parses a record of record.h from an untrusted file. Checks the types of the fields that readers
// use, and that the fields of the record's state are present. Keeps other fields. Errors: DATA_LOSS
// "FIELD: expected ..., got ...".
absl::StatusOr<nlohmann::ordered_json> ParseRecord(absl::string_view text);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PARSE_RECORD_H_
