#include "client/batch/record.h"

#include <google/protobuf/util/json_util.h>

#include <cmath>

#include "absl/strings/str_cat.h"
#include "client/batch/text_values.h"
#include "model/base/sha256.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kLongestReason = 300;  // why a text is no record

// A float as the shortest decimal with the same value: 0.1 instead of 0.10000000149.
ordered_json Number(float value) { return ordered_json::parse(WeightText(value)); }

// Rounded to micrometres and millionths of a degree, so that records stay short.
double Rounded(double value) { return std::round(value * 1e6) / 1e6; }

ordered_json LabelsJson(const Labels& labels) {
  ordered_json object = ordered_json::object();
  for (const ClassWeight& label : labels) object[label.interaction_class] = Number(label.weight);
  return object;
}

// In the order of the message's fields.
ordered_json QualityJson(const Quality& quality) {
  ordered_json object = ordered_json::object();
  const google::protobuf::Descriptor& fields = *v1::QualityFigures::descriptor();
  for (int i = 0; i < fields.field_count(); ++i) {
    const auto figure = quality.figures.find(fields.field(i)->name());
    if (figure != quality.figures.end()) object[figure->first] = Rounded(figure->second);
  }
  return object;
}

ordered_json Begin(const Item& item, const char* state) {
  ordered_json record = {
      {"item", item.number}, {"id", item.id}, {"state", state}, {"name", item.name}};
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

ordered_json WithAnswer(const Item& item, const char* state, const Answer& answer) {
  const SynthesisResult& result = answer.result;
  ordered_json record = Begin(item, state);
  record["leader_sha256"] = answer.leader.sha256;
  record["labels"] = LabelsJson(item.labels);
  if (item.leader->partner_direction.has_value()) {
    const motion::Vec3& to = *item.leader->partner_direction;
    record["partner_direction"] = {Number(to.x), Number(to.y), Number(to.z)};
  }
  record["model"] = ModelText(result);
  record["seed"] = result.seed;
  record["variety"] = Number(result.variety);
  record["candidates"] = result.candidates;
  record["request_id"] = result.request_id;
  record["frames"] = result.pair.follower.frame_count();
  record["frame_rate_hz"] = result.pair.follower.frame_rate_hz;
  record["skeleton"] = answer.skeleton;
  record["quality"] = QualityJson(answer.quality);
  if (answer.quality.unfamiliarity) {
    record["unfamiliarity"] = Rounded(*answer.quality.unfamiliarity);
  }
  record["answers"] = answer.retry + 1;
  AddMadeBy(MadeByOf(result), &record);
  return record;
}

}  // namespace

MadeBy MadeByOf(const SynthesisResult& result) {
  return {result.cleaned_up, result.engine, result.server_version};
}

std::string ModelText(const SynthesisResult& result) {
  return absl::StrCat(result.model_name, "@", result.model_version);
}

std::optional<MadeBy> MadeByOf(const v1::IndexEntry& record) {
  if (!record.has_cleaned_up()) return std::nullopt;
  return MadeBy{record.cleaned_up(), record.engine(), record.server_version()};
}

void AddMadeBy(const MadeBy& made_by, ordered_json* record) {
  (*record)["cleaned_up"] = made_by.cleaned_up;
  if (!made_by.engine.empty()) (*record)["engine"] = made_by.engine;
  if (!made_by.server_version.empty()) (*record)["server_version"] = made_by.server_version;
}

ordered_json DoneRecord(const Item& item, const Answer& answer,
                        const std::vector<EncodedFile>& files) {
  ordered_json record = WithAnswer(item, kDone, answer);
  record["files"] = ordered_json::array();
  for (const EncodedFile& file : files) {
    record["files"].push_back({{"path", item.name + file.ending},
                               {"bytes", file.content.size()},
                               {"sha256", base::Sha256Hex(file.content)}});
  }
  AddExtra(item, &record);
  return record;
}

ordered_json RejectedRecord(const Item& item, const Answer& answer,
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

absl::StatusOr<v1::IndexEntry> ParseRecord(absl::string_view text) {
  v1::IndexEntry record;
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;
  const auto parsed = google::protobuf::util::JsonStringToMessage(
      google::protobuf::StringPiece(text.data(), text.size()), &record, options);
  if (!parsed.ok()) {
    return absl::DataLossError(
        absl::StrCat("is not a record: ", base::Printable(parsed.ToString(), kLongestReason)));
  }
  for (const char* state : {kDone, kRejected, kFailed}) {
    if (record.state() == state) return record;
  }
  return absl::DataLossError("state: expected done, rejected or failed, got another");
}

}  // namespace duet::client::batch
