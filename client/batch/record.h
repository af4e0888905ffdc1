#ifndef DUET_CLIENT_BATCH_RECORD_H_
#define DUET_CLIENT_BATCH_RECORD_H_

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/plan.h"
#include "client/request.h"
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
// Absent for items without an answer.
std::optional<MadeBy> MadeByOf(const v1::IndexEntry& record);
void AddMadeBy(const MadeBy& made_by, nlohmann::ordered_json* record);

// Quality of an answer: the figures of QualityFigures of proto/duet/batch/v1/batch.proto by their
// names there. Figures are absent if the skeleton does not have their joints.
struct Quality {
  std::map<std::string, double> figures;
  std::optional<double> unfamiliarity;  // IndexEntry.unfamiliarity
};

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

// Parses a record of the journal, whose digest was right. Ignores fields of later versions.
// DATA_LOSS for what is no record.
absl::StatusOr<v1::IndexEntry> ParseRecord(absl::string_view text);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECORD_H_
