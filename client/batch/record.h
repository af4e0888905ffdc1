#ifndef DUET_CLIENT_BATCH_RECORD_H_
#define DUET_CLIENT_BATCH_RECORD_H_

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/answer.h"
#include "client/batch/leaders.h"
#include "client/batch/plan.h"
#include "client/result.h"

namespace duet::client::batch {

// The result of an item: IndexEntry of proto/duet/batch/v1/batch.proto.

inline constexpr char kDone[] = "done";
inline constexpr char kRejected[] = "rejected";
inline constexpr char kFailed[] = "failed";

// What decides the bits of an answer besides its request and the weights.
struct MadeBy {
  bool cleaned_up = false;
  std::string engine;
  std::string server_version;
};

MadeBy MadeByOf(const SynthesisResult& result);
// "name@version" of its model.
std::string ModelText(const SynthesisResult& result);
// Absent for items without an answer.
std::optional<MadeBy> MadeByOf(const v1::IndexEntry& record);
void AddMadeBy(const MadeBy& made_by, nlohmann::ordered_json* record);

// An answer to record.
struct Answer {
  const SynthesisResult& result;  // its pair has the rate of the output
  const LoadedLeader& leader;
  Quality quality;
  int skeleton = 0;  // index into dataset.json's
  int retry = 0;     // 0: the first answer
};

// One JSON object with the fields in the proto's order and without times, so that the same item
// always has the same record.
nlohmann::ordered_json DoneRecord(const Item& item, const Answer& answer,
                                  const std::vector<EncodedFile>& files);
nlohmann::ordered_json RejectedRecord(const Item& item, const Answer& answer,
                                      const std::vector<std::string>& reasons);
nlohmann::ordered_json FailedRecord(const Item& item, const absl::Status& error);

// The record as one line, without newline. Bytes that are not UTF-8 become the replacement
// character.
std::string Line(const nlohmann::ordered_json& record);

// Parses a record of the journal, whose digest was right. Ignores fields of later versions.
// DATA_LOSS for what is no record.
absl::StatusOr<v1::IndexEntry> ParseRecord(absl::string_view text);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECORD_H_
