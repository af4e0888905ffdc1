#ifndef DUET_CLIENT_BATCH_RECORD_H_
#define DUET_CLIENT_BATCH_RECORD_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/made_by.h"
#include "client/batch/plan.h"
#include "client/batch/quality.h"
#include "client/request.h"

namespace duet::client::batch {

// The result of an item: IndexEntry of proto/duet/batch/v1/batch.proto.

inline constexpr char kDone[] = "done";
inline constexpr char kRejected[] = "rejected";
inline constexpr char kFailed[] = "failed";

struct RecordedFile {
  std::string path;
  uint64_t bytes = 0;
  std::string sha256;
};

// An answer as it is recorded in the index.
struct RecordedAnswer {
  std::string leader_sha256;
  std::string model;  // name@version
  uint64_t seed = 0;
  float variety = 0;
  int candidates = 1;
  std::string request_id;
  std::vector<WeightKeyframe> keyframes;
  int frames = 0;
  double frame_rate_hz = 0;
  int skeleton = 0;  // index into dataset.json's
  Quality quality;
  std::vector<float> pin_metres;  // of the leader's pins
  int answers = 1;
  MadeBy made_by;
};

// One JSON object with the fields in the proto's order and without times, so that the same item
// always has the same record.
nlohmann::ordered_json DoneRecord(const Item& item, const RecordedAnswer& answer,
                                  const std::vector<RecordedFile>& files);
nlohmann::ordered_json RejectedRecord(const Item& item, const RecordedAnswer& answer,
                                      const std::vector<std::string>& reasons);
nlohmann::ordered_json FailedRecord(const Item& item, const absl::Status& error);

// The record as one line, without newline. Bytes that are not UTF-8 become the replacement
// character.
std::string Line(const nlohmann::ordered_json& record);

// Parses a record from an untrusted file. Checks the types of the fields that readers use, and that
// the fields of the record's state are present. Keeps other fields. Errors: DATA_LOSS
// "FIELD: expected ..., got ...".
absl::StatusOr<nlohmann::ordered_json> ParseRecord(absl::string_view text);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECORD_H_
