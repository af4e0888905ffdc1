#include "client/batch/record.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "client/batch/text_values.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

// A float as the shortest decimal with the same value: 0.1 instead of 0.10000000149.
ordered_json Number(float value) { return ordered_json::parse(WeightText(value)); }

// Rounded to micrometres and millionths of a degree, so that records stay short.
double Rounded(double value) { return std::round(value * 1e6) / 1e6; }

ordered_json LabelsJson(const Labels& labels) {
  ordered_json object = ordered_json::object();
  for (const ClassWeight& label : labels) object[label.interaction_class] = Number(label.weight);
  return object;
}

ordered_json KeyframesJson(const std::vector<WeightKeyframe>& keyframes) {
  ordered_json array = ordered_json::array();
  for (const WeightKeyframe& keyframe : keyframes) {
    array.push_back({{"frame", keyframe.frame}, {"labels", LabelsJson(keyframe.weights)}});
  }
  return array;
}

ordered_json QualityJson(const Quality& quality) {
  ordered_json object = ordered_json::object();
  for (const char* name : kQualityFields) {
    const auto figure = quality.figures.find(name);
    if (figure != quality.figures.end()) object[name] = Rounded(figure->second);
    if (name == kRecognisedClass && !quality.recognised_class.empty()) {
      object[name] = quality.recognised_class;
    }
  }
  return object;
}

ordered_json Begin(const Item& item, const char* state) {
  ordered_json record = {
      {"item", item.number}, {"id", item.id}, {"state", state}, {"name", item.name}};
  if (!item.full_name.empty()) record["full_name"] = item.full_name;
  record["leader"] = item.leader->given;
  record["leader_sha256"] = "";
  record["side"] = std::string(SideName(item.side));
  if (!item.leader->group.empty()) record["group"] = item.leader->group;
  record["reaction"] = item.reaction;
  return record;
}

void AddExtra(const Item& item, ordered_json* record) {
  if (item.leader->extra.empty()) return;
  ordered_json extra = ordered_json::object();
  for (const auto& [name, value] : item.leader->extra) extra[name] = value;
  (*record)["extra"] = std::move(extra);
}

ordered_json WithAnswer(const Item& item, const char* state, const RecordedAnswer& answer) {
  ordered_json record = Begin(item, state);
  record["leader_sha256"] = answer.leader_sha256;
  if (answer.keyframes.empty()) {
    record["labels"] = LabelsJson(item.labels);
  } else {
    record["keyframes"] = KeyframesJson(answer.keyframes);
  }
  if (item.leader->partner_direction.has_value()) {
    const motion::Vec3& to = *item.leader->partner_direction;
    record["partner_direction"] = {Number(to.x), Number(to.y), Number(to.z)};
  }
  if (!item.leader->pins.empty()) {
    record["constraints"] = PinsJson(item.leader->pins, answer.pin_metres);
  }
  record["model"] = answer.model;
  record["seed"] = answer.seed;
  record["variety"] = Number(answer.variety);
  record["candidates"] = answer.candidates;
  record["request_id"] = answer.request_id;
  record["frames"] = answer.frames;
  record["frame_rate_hz"] = answer.frame_rate_hz;
  record["skeleton"] = answer.skeleton;
  record["quality"] = QualityJson(answer.quality);
  if (answer.quality.unfamiliarity) {
    record["unfamiliarity"] = Rounded(*answer.quality.unfamiliarity);
  }
  record["answers"] = answer.answers;
  AddMadeBy(answer.made_by, &record);
  return record;
}

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
                                 {"keyframes", IsKeyframes, "an array of labels"}};

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

ordered_json DoneRecord(const Item& item, const RecordedAnswer& answer,
                        const std::vector<RecordedFile>& files) {
  ordered_json record = WithAnswer(item, kDone, answer);
  record["files"] = ordered_json::array();
  for (const RecordedFile& file : files) {
    record["files"].push_back(
        {{"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}});
  }
  AddExtra(item, &record);
  return record;
}

ordered_json RejectedRecord(const Item& item, const RecordedAnswer& answer,
                            const std::vector<std::string>& reasons) {
  ordered_json record = WithAnswer(item, kRejected, answer);
  record["reasons"] = reasons;
  AddExtra(item, &record);
  return record;
}

ordered_json FailedRecord(const Item& item, const absl::Status& error) {
  ordered_json record = Begin(item, kFailed);
  record.erase("leader_sha256");
  if (!item.labels.empty()) record["labels"] = LabelsJson(item.labels);
  record["error"] = {{"code", absl::StatusCodeToString(error.code())},
                     {"message", std::string(error.message())}};
  AddExtra(item, &record);
  return record;
}

std::string Line(const ordered_json& record) {
  return record.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

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
