#include "client/batch/answer.h"

#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "client/batch/text_values.h"
#include "client/error_details.h"
#include "model/base/sha256.h"
#include "model/base/text.h"
#include "model/body/contact.h"
#include "model/body/limbs.h"
#include "model/body/liveliness.h"
#include "model/body/posture.h"
#include "model/formats/motion_file.h"
#include "model/motion/feet.h"
#include "model/motion/levelling.h"
#include "model/motion/recorded_motion.h"
#include "model/motion/resample.h"

namespace duet::client::batch {
namespace {

// The pair as an upright camera would have captured it.
motion::ClipPair Upright(motion::ClipPair pair, const std::optional<motion::Vec3>& up) {
  if (!up.has_value()) return pair;
  const motion::Levelling levelling(*up, 0);
  for (motion::Clip* clip : {&pair.leader, &pair.follower}) {
    clip->poses = levelling.Apply(std::move(clip->poses));
  }
  return pair;
}

formats::Format FileFormat(v1::Format format) {
  if (format == v1::FORMAT_BVH) return formats::Format::kBvh;
  return format == v1::FORMAT_GLB ? formats::Format::kGlb : formats::Format::kNpy;
}

motion::Clip AtRate(motion::Clip clip, double rate_hz) {
  if (clip.frame_rate_hz == rate_hz || clip.frame_count() < 2) return clip;
  clip.poses = motion::Resample(clip.poses, clip.frame_rate_hz, rate_hz);
  clip.frame_rate_hz = rate_hz;
  return clip;
}

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

Meaning MeaningOf(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
      return Meaning::kWait;
    case absl::StatusCode::kResourceExhausted:
      // Without a retry delay, the request itself is too large.
      return RetryDelay(status).has_value() ? Meaning::kWait : Meaning::kRefused;
    case absl::StatusCode::kNotFound:
    case absl::StatusCode::kPermissionDenied:
    case absl::StatusCode::kUnauthenticated:
    case absl::StatusCode::kUnimplemented:
      return Meaning::kStop;
    default:
      return IsPermanent(status) ? Meaning::kRefused : Meaning::kTryAgain;
  }
}

flow::CallEnd CallEndOf(const absl::Status& status) {
  if (status.ok() || MeaningOf(status) != Meaning::kWait) return flow::CallEnd::kAnswered;
  return status.code() == absl::StatusCode::kUnavailable ? flow::CallEnd::kAway
                                                         : flow::CallEnd::kRefused;
}

SynthesisRequest ToRequest(const Item& item, const Recipe& recipe, const ModelInfo& model,
                           const LoadedLeader& leader, int retry) {
  SynthesisRequest request;
  request.model.name = model.name;
  request.model.version = model.version;
  request.leader = leader.clip;
  request.weights = item.labels;
  request.follower_start = leader.follower_start;
  request.partner_direction = item.leader->partner_direction;
  request.up = recipe.input.up;
  request.seed = SeedOf(item, recipe.seed, leader.sha256 + leader.start_sha256, retry);
  request.variety = recipe.variety;
  request.candidates = recipe.candidates;
  request.priority = Priority::kBulk;
  request.request_id = absl::StrCat("batch-", item.id, retry == 0 ? "" : absl::StrCat("-", retry));
  return request;
}

Quality Measure(const SynthesisResult& result, const motion::Skeleton& skeleton,
                const std::optional<motion::Vec3>& up) {
  const motion::ClipPair pair = Upright(result.pair, up);
  const motion::Poses& leader = pair.leader.poses;
  const motion::Poses& follower = pair.follower.poses;
  Quality quality;
  std::map<std::string, double>& figures = quality.figures;
  const double lean =
      body::MeasureLean(follower, skeleton, pair.follower.frame_rate_hz, body::LeanFrom::kHips)
          .max_degrees;
  if (!std::isnan(lean)) figures["lean_degrees"] = lean;
  if (skeleton.feet.has_value()) {
    const body::FloorGap gap =
        body::MeasureFloorGap(follower, skeleton, motion::FloorHeight(*skeleton.feet, leader));
    figures["foot_above_floor_metres"] = gap.above;
    figures["foot_below_floor_metres"] = gap.below;
  }
  figures["distance_metres"] = body::RootDistance(leader, follower, skeleton);
  figures["penetration_metres"] =
      body::MeasurePenetration(leader, follower, skeleton,
                               body::LimbParts(body::FindBody(skeleton)))
          .max_depth_metres;
  figures["range_of_motion_metres"] = body::RangeOfMotion(follower);
  if (result.grade.has_value()) {
    figures["twisted"] = result.grade->twisted;
    figures["skating"] = result.grade->skating;
    figures["leader_skating"] = result.grade->leader_skating;
    figures["overlapping"] = result.grade->overlapping;
  }
  quality.unfamiliarity = result.unfamiliarity;
  return quality;
}

std::vector<std::string> WhyRejected(const v1::QualityFilter& filter, const Quality& quality) {
  std::map<std::string, double> figures = quality.figures;
  if (quality.unfamiliarity) figures["unfamiliarity"] = *quality.unfamiliarity;
  if (figures.count("skating") > 0) {
    figures["skating_over_leader"] = figures["skating"] - figures["leader_skating"];
  }
  std::vector<std::string> reasons;
  const auto check = [&](absl::string_view limit_name, double limit) {
    const std::string name(limit_name.substr(4));  // without max_ or min_
    const auto found = figures.find(name);
    if (found == figures.end()) return;
    const bool at_most = absl::StartsWith(limit_name, "max_");
    if (at_most ? found->second <= limit : found->second >= limit) return;
    reasons.push_back(absl::StrFormat("%s: expected at %s %g, got %.4g", name,
                                      at_most ? "most" : "least", limit, found->second));
  };
  std::vector<const google::protobuf::FieldDescriptor*> limits;
  filter.GetReflection()->ListFields(filter, &limits);
  for (const google::protobuf::FieldDescriptor* limit : limits) {
    if (limit->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
    check(limit->name(), filter.GetReflection()->GetDouble(filter, limit));
  }
  return reasons;
}

std::vector<std::string> EndingsOf(v1::Format format) {
  if (format == v1::FORMAT_BVH) return {".leader.bvh", ".follower.bvh"};
  return {format == v1::FORMAT_GLB ? ".glb" : ".npy"};
}

motion::ClipPair AtOutputRate(motion::ClipPair pair, const v1::Output& output) {
  if (!output.has_frame_rate_hz()) return pair;
  const double rate_hz = output.frame_rate_hz();
  return {AtRate(std::move(pair.leader), rate_hz), AtRate(std::move(pair.follower), rate_hz)};
}

absl::StatusOr<std::vector<EncodedFile>> Encode(const v1::Output& output,
                                                const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton) {
  absl::Status status = CheckPair(pair);
  if (!status.ok()) return status;
  std::vector<EncodedFile> all;
  for (const int number : output.formats()) {
    const auto format = static_cast<v1::Format>(number);
    std::vector<motion::Clip> people = {pair.leader, pair.follower};
    for (const std::string& ending : EndingsOf(format)) {
      const bool together = format != v1::FORMAT_BVH;
      // Labels and model are in the index.
      absl::StatusOr<std::string> content = formats::FormatPeople(
          FileFormat(format), together ? people : std::vector<motion::Clip>{people.front()},
          skeleton);
      if (!content.ok()) return content.status();
      all.push_back({ending, *std::move(content)});
      people.erase(people.begin());
    }
  }
  return all;
}

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
