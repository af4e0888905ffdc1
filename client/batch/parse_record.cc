#include "client/batch/parse_record.h"

#include <algorithm>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "client/batch/record.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

// Larger than the depth of any record.
constexpr int kMaxDepth = 8;

using IsOfType = bool (*)(const ordered_json& value);

bool IsText(const ordered_json& value) { return value.is_string(); }
bool IsNumber(const ordered_json& value) { return value.is_number(); }
bool IsCount(const ordered_json& value) { return value.is_number_unsigned(); }
bool IsTexts(const ordered_json& value) {
  return value.is_array() && std::all_of(value.begin(), value.end(), IsText);
}
bool IsNumbers(const ordered_json& value) {
  return value.is_object() && std::all_of(value.begin(), value.end(), IsNumber);
}
// Whether an object has a field of a type.
bool Has(const ordered_json& object, const char* name, IsOfType is_type) {
  const auto found = object.find(name);
  return found != object.end() && is_type(*found);
}
// Figures, and the class that a classifier recognised.
bool IsQuality(const ordered_json& value) {
  if (!value.is_object()) return false;
  for (const auto& [name, figure] : value.items()) {
    if (name == "recognised_class" ? !IsText(figure) : !IsNumber(figure)) return false;
  }
  return true;
}
bool IsKeyframes(const ordered_json& value) {
  return value.is_array() && std::all_of(value.begin(), value.end(), [](const ordered_json& one) {
           return one.is_object() && Has(one, "labels", IsNumbers);
         });
}
bool IsFiles(const ordered_json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const ordered_json& file) {
           return file.is_object() && Has(file, "path", IsText) && Has(file, "bytes", IsCount) &&
                  Has(file, "sha256", IsText);
         });
}

struct Field {
  const char* name;
  IsOfType is_type;
  const char* expected;
};
constexpr Field kOfAnyRecord[] = {{"state", IsText, "a text"}, {"name", IsText, "a text"}};
constexpr Field kOfAnAnswer[] = {{"id", IsText, "a text"},
                                 {"side", IsText, "a text"},
                                 {"model", IsText, "a text"},
                                 {"frames", IsCount, "a number of frames"},
                                 {"frame_rate_hz", IsNumber, "a number"},
                                 {"quality", IsQuality, "an object of figures"}};
constexpr Field kOfDone[] = {{"files", IsFiles, "an array of files"}};
constexpr Field kOfRejected[] = {{"reasons", IsTexts, "an array of texts"}};
constexpr Field kWhereGiven[] = {{"skeleton", IsCount, "an index"},
                                 {"labels", IsNumbers, "an object of numbers"},
                                 {"keyframes", IsKeyframes, "an array of labels"},
                                 {"shard", IsText, "a text"},
                                 {"split", IsText, "a text"}};

absl::Status CheckFields(const ordered_json& record, absl::Span<const Field> fields,
                         bool must_be_there) {
  for (const Field& field : fields) {
    if (!must_be_there && !record.contains(field.name)) continue;
    if (Has(record, field.name, field.is_type)) continue;
    return absl::DataLossError(
        absl::StrCat(field.name, ": expected ", field.expected, ", got ",
                     record.contains(field.name) ? "something else" : "none"));
  }
  return absl::OkStatus();
}

absl::Status CheckRecord(const ordered_json& record) {
  absl::Status status = CheckFields(record, kOfAnyRecord, true);
  if (status.ok()) status = CheckFields(record, kWhereGiven, false);
  if (!status.ok() || record["state"] == kFailed) return status;
  status = CheckFields(record, kOfAnAnswer, true);
  if (!status.ok()) return status;
  if (record["state"] == kDone) return CheckFields(record, kOfDone, true);
  if (record["state"] == kRejected) return CheckFields(record, kOfRejected, true);
  return absl::DataLossError("state: expected done, rejected or failed, got another");
}

}  // namespace

absl::StatusOr<ordered_json> ParseRecord(absl::string_view text) {
  bool too_deep = false;
  const auto within_depth = [&too_deep](int depth, ordered_json::parse_event_t, ordered_json&) {
    too_deep = too_deep || depth > kMaxDepth;
    return !too_deep;
  };
  ordered_json record = ordered_json::parse(text.begin(), text.end(), within_depth, false);
  if (too_deep || !record.is_object()) return absl::DataLossError("is not a record");
  absl::Status status = CheckRecord(record);
  if (!status.ok()) return status;
  return record;
}

}  // namespace duet::client::batch
