#ifndef DUET_CLIENT_BATCH_PARSE_RECORD_H_
#define DUET_CLIENT_BATCH_PARSE_RECORD_H_

#include <nlohmann/json.hpp>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// Reads back what record.h writes, from a file that this program may not have written. Of the
// fields that readers rely on, those that are there are of their types, and those of its state are
// there; whatever else it holds is kept.
// Errors: DATA_LOSS "field: what came, what was wanted".
absl::StatusOr<nlohmann::ordered_json> ParseRecord(absl::string_view text);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PARSE_RECORD_H_
