#include "client/batch/record.h"

#include <cmath>

#include "client/batch/text_values.h"
#include "model/base/sha256.h"

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

void AddIf(const char* name, const std::optional<double>& value, ordered_json* object) {
  if (value.has_value()) (*object)[name] = Rounded(*value);
}

ordered_json QualityJson(const Quality& quality) {
  ordered_json object = ordered_json::object();
  AddIf("lean_degrees", quality.lean_degrees, &object);
  AddIf("foot_above_floor_metres", quality.foot_above_floor_metres, &object);
  AddIf("foot_below_floor_metres", quality.foot_below_floor_metres, &object);
  object["distance_metres"] = Rounded(quality.distance_metres);
  object["penetration_metres"] = Rounded(quality.penetration_metres);
  object["range_of_motion_metres"] = Rounded(quality.range_of_motion_metres);
  if (!quality.recognised_class.empty()) object["recognised_class"] = quality.recognised_class;
  AddIf("class_probability", quality.class_probability, &object);
  if (quality.grade.has_value()) {
    object["twisted"] = Rounded(quality.grade->twisted);
    object["skating"] = Rounded(quality.grade->skating);
    object["leader_skating"] = Rounded(quality.grade->leader_skating);
    object["overlapping"] = Rounded(quality.grade->overlapping);
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
  AddIf("unfamiliarity", answer.unfamiliarity, &record);
  record["answers"] = answer.answers;
  AddMadeBy(answer.made_by, &record);
  return record;
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

std::string LargestClass(const ordered_json& record) {
  std::string best = "none";
  double largest = 0;
  const auto look = [&](const ordered_json& labels) {
    for (const auto& [name, weight] : labels.items()) {
      if (weight.get<double>() <= largest) continue;
      largest = weight.get<double>();
      best = name;
    }
  };
  if (record.contains("labels")) look(record["labels"]);
  if (record.contains("keyframes")) {
    for (const ordered_json& keyframe : record["keyframes"]) look(keyframe["labels"]);
  }
  return best;
}

std::string SplitOfRecord(const Splits& splits, const ordered_json& record) {
  if (!splits.any()) return "";
  const auto text = [&record](const char* field) {
    const auto found = record.find(field);
    return found != record.end() && found->is_string() ? found->get<std::string>() : "";
  };
  const std::string group = text("group");
  return SplitOf(splits, group.empty() ? text("leader_sha256") : base::Sha256Hex(group));
}

std::string Line(const ordered_json& record) {
  return record.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace duet::client::batch
