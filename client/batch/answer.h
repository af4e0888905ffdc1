#ifndef DUET_CLIENT_BATCH_ANSWER_H_
#define DUET_CLIENT_BATCH_ANSWER_H_

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/flow/call_gate.h"
#include "client/batch/leaders.h"
#include "client/batch/plan.h"
#include "client/request.h"
#include "client/result.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// What the error of a call means for its item.
enum class Meaning {
  kWait,      // the server is full or away: the item is retried later
  kTryAgain,  // a temporary failure of this call
  kRefused,   // the server will always reject the item
  kStop,      // every item would fail: credentials, or a missing model
};
Meaning MeaningOf(const absl::Status& status);
flow::CallEnd CallEndOf(const absl::Status& status);

// The request of an item. `retry` selects the seed; 0 is the first. Its id is the same in every
// call for the item.
SynthesisRequest ToRequest(const Item& item, const Recipe& recipe, const ModelInfo& model,
                           const LoadedLeader& leader, int retry);

// Quality of an answer: the figures of QualityFigures of proto/duet/batch/v1/batch.proto by their
// names there. Figures are absent if the skeleton does not have their joints.
struct Quality {
  std::map<std::string, double> figures;
  std::optional<double> unfamiliarity;  // IndexEntry.unfamiliarity
};

// The quality of the result's pair, which has at least one frame and the joints of the skeleton. It
// is measured in the level world: `up` is the vertical of the leaders.
Quality Measure(const SynthesisResult& result, const motion::Skeleton& skeleton,
                const std::optional<motion::Vec3>& up);

// The limits that an answer exceeds, one text for each; empty if it passes.
std::vector<std::string> WhyRejected(const v1::QualityFilter& filter, const Quality& quality);

// A file of a pair.
struct EncodedFile {
  std::string ending;  // ".npy", ".leader.bvh"
  std::string content;
};

// What follows an item's name in the names of its files of a format.
std::vector<std::string> EndingsOf(v1::Format format);

// The pair at the frame rate of the recipe, if it states one. Both people have the same number of
// frames before and after.
motion::ClipPair AtOutputRate(motion::ClipPair pair, const v1::Output& output);

// The files of a pair: two for BVH, one for any other format. INVALID_ARGUMENT for a pair that the
// format cannot hold.
absl::StatusOr<std::vector<EncodedFile>> Encode(const v1::Output& output,
                                                const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton);

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

#endif  // DUET_CLIENT_BATCH_ANSWER_H_
