#include "client/cli/reaction.h"

#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/batch/leaders.h"
#include "client/cli/flags.h"
#include "client/internal/proto_conversion.h"
#include "client/model_skeleton.h"
#include "duet/v1/synthesis.pb.h"
#include "model/base/file.h"
#include "model/base/program_flags.h"
#include "model/base/text.h"
#include "model/messages/message_text.h"
#include "model/motion/motion_limits.h"

namespace duet::client::cli {
namespace {

using batch::Expected;

absl::StatusOr<float> ParseVariety(absl::string_view text) {
  float variety = 0;
  if (absl::SimpleAtof(text, &variety) && variety >= 0 && variety <= 2) return variety;
  return Expected("a number from 0 to 2", text);
}

absl::Status ReadLeader(const ReactionArguments& arguments, formats::ReadOptions options,
                        SynthesisRequest* request, std::vector<std::string>* notes) {
  retargeting::ReadingReport report;
  options.side = arguments.leader_side;
  options.report = &report;
  absl::StatusOr<motion::Clip> leader = ReadMotion(arguments.leader, options);
  if (!leader.ok()) return leader.status();
  request->leader = *std::move(leader);
  if (notes != nullptr) *notes = report.Notes();
  return absl::OkStatus();
}

absl::Status Refused(const char* field, const std::string& expected, const std::string& got) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": expected ", expected, ", got ", got));
}

template <typename Point>
motion::Vec3 FromProto(const Point& point) {
  return {point.x(), point.y(), point.z()};
}

std::vector<ClassWeight> FromProto(const v1::LabelVector& labels) {
  std::vector<ClassWeight> weights;
  for (const v1::ClassWeight& weight : labels.weights()) {
    weights.push_back({weight.interaction_class(), weight.weight()});
  }
  return weights;
}

ModelChoice FromProto(const v1::ModelSelector& selector) {
  ModelChoice choice;
  choice.name = selector.name();
  if (selector.has_version()) choice.version = static_cast<int>(selector.version());
  choice.version_label = selector.version_label();
  return choice;
}

absl::Status FillOptions(const v1::SynthesizeRequest& in, SynthesisOptions* out) {
  if (in.has_partner_direction()) out->partner_direction = FromProto(in.partner_direction());
  if (in.has_up()) out->up = FromProto(in.up());
  if (in.has_seed()) out->seed = in.seed();
  if (in.has_variety()) out->variety = in.variety();
  if (in.has_reaction()) out->reaction = in.reaction();
  if (in.has_candidates()) out->candidates = static_cast<int>(in.candidates());
  if (in.clean_up() != v1::CLEAN_UP_UNSPECIFIED) out->clean_up = in.clean_up() == v1::CLEAN_UP_ON;
  out->rotations = in.reply_rotations();
  if (in.has_priority()) {
    if (in.priority() == v1::PRIORITY_UNSPECIFIED) {
      return Refused("priority", "PRIORITY_INTERACTIVE or PRIORITY_BULK", "PRIORITY_UNSPECIFIED");
    }
    if (in.priority() == v1::PRIORITY_BULK) out->priority = Priority::kBulk;
  }
  if (in.has_chunk_frames()) out->chunk_frames = static_cast<int>(in.chunk_frames());
  for (const v1::JointConstraint& constraint : in.constraints()) {
    out->constraints.push_back({constraint.joint_name(), static_cast<int>(constraint.frame()),
                                FromProto(constraint.position()), constraint.softness()});
  }
  return absl::OkStatus();
}

absl::StatusOr<SynthesisRequest> FromProto(const v1::SynthesizeRequest& in) {
  if (in.reply_joint_names_size() > 0) {
    return Refused("reply_joint_names", "none: every output needs all joints",
                   absl::StrCat(in.reply_joint_names_size()));
  }
  if (in.has_leader()) return Refused("leader", "none: a flag names its file", "one");
  SynthesisRequest out;
  const absl::Status options = FillOptions(in, &out);
  if (!options.ok()) return options;
  out.model = FromProto(in.model());
  out.weights = FromProto(in.label_vector());
  for (const v1::LabelKeyframe& keyframe : in.label_keyframes()) {
    out.keyframes.push_back(
        {static_cast<int>(keyframe.frame()), FromProto(keyframe.label_vector())});
  }
  if (in.follower_start().has_root_position()) {
    out.follower_start = FromProto(in.follower_start().root_position());
  } else if (in.follower_start().has_pose()) {
    out.follower_start = internal::ToPoints(in.follower_start().pose().positions());
  }
  return out;
}

absl::Status InFile(const std::filesystem::path& file, const absl::Status& status) {
  return {status.code(), absl::StrCat(file.string(), ": ", status.message())};
}

// Needs no skeleton, so that a wrong name is rejected before the first call to the server.
absl::Status CheckInputs(const ReactionArguments& arguments) {
  absl::Status status = ReadJoints(arguments.input.joint_map).status();
  if (status.ok() && !arguments.leader.empty()) {
    status = formats::CheckReadable(arguments.leader, arguments.input.format);
  }
  const std::string& start = arguments.follower_start;
  if (!status.ok() || start.empty() || batch::ParsePoint(start).has_value()) return status;
  status = formats::CheckReadable(start, std::nullopt);
  if (!absl::IsNotFound(status)) return status;
  return absl::NotFoundError(
      absl::StrCat("--follower-start: ", status.message(), "; expected a motion file or X,Y,Z"));
}

// The request of the file with the fields of the flags.
absl::StatusOr<SynthesisRequest> StartRequest(const ReactionArguments& arguments) {
  absl::StatusOr<SynthesisRequest> request = SynthesisRequest();
  if (!arguments.request.empty()) request = ReadRequestFile(arguments.request);
  if (!request.ok()) return request;
  if (arguments.model) request->model = *arguments.model;
  if (!arguments.weights.empty() || !arguments.keyframes.empty()) {
    request->weights = arguments.weights;
    request->keyframes = arguments.keyframes;
  }
  if (arguments.seed) request->seed = *arguments.seed;
  if (arguments.variety) request->variety = *arguments.variety;
  if (arguments.candidates) request->candidates = *arguments.candidates;
  return request;
}

}  // namespace

void AddReactionFlags(CLI::App* app, ReactionArguments* arguments) {
  AddValue(app, kReactionGroup, "--request", "FILE", &arguments->request,
           "File with a request: the protobuf message duet.v1.SynthesizeRequest in text "
           "format, with fields that have no flag too; flags override it");
  CLI::Option* label = AddParsedList(
      app, kReactionGroup, "--label", "CLASS[=WEIGHT]", ParseClassWeight, &arguments->weights,
      "Weight of an interaction class, such as kick=1 or hug=-0.5; repeatable");
  AddParsedList(app, kReactionGroup, "--keyframe", "FRAME:CLASS[=WEIGHT],...", ParseKeyframe,
                &arguments->keyframes,
                "Weights from a frame on, for weights that change over time; repeatable")
      ->excludes(label);
  AddParsed(app, kReactionGroup, "--model", "NAME[@VERSION|:LABEL]", ParseModelChoice,
            &arguments->model, "Model to use (default: the server's default model)");
  AddValue(app, kReactionGroup, "--follower-start", "FILE|X,Y,Z", &arguments->follower_start,
           "Start of the follower: a motion file (its first frame), or X,Y,Z of the root "
           "joint in metres, y up; Y is about 1 above the floor for a person who stands");
  AddParsed(app, kReactionGroup, "--seed", "SEED", ParseSeed, &arguments->seed,
            "Seed of a model that samples; the same seed gives the same answer (default: derived "
            "from the leader; a typical one in live sessions)");
  AddParsed(app, kReactionGroup, "--variety", "VARIETY", ParseVariety, &arguments->variety,
            "Variety of the answers of such a model: 0 typical, 1 as varied as people, at most 2 "
            "(default: 1)");
  AddValue(app, kReactionGroup, "--candidates", "COUNT", &arguments->candidates,
           "Samples that such a model draws for each window, from which the best becomes the "
           "answer; higher values take longer (default: 1)")
      ->check(base::InRange(1, 16));
}

void AddLeaderFlags(CLI::App* app, ReactionArguments* arguments) {
  AddParsed(app, kInputGroup, "--leader-side", "left|right", batch::ParseSide,
            &arguments->leader_side, "The person who leads in a file with two people")
      ->default_str("left");
  AddReadingFlags(app, &arguments->input);
}

absl::StatusOr<ClassWeight> ParseClassWeight(absl::string_view text) {
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits('=', 1));
  ClassWeight weight{parts.first, 1};
  const bool has_weight = absl::StrContains(text, '=');
  if (weight.interaction_class.empty() ||
      (has_weight && !absl::SimpleAtof(parts.second, &weight.weight))) {
    return Expected("CLASS or CLASS=WEIGHT such as kick or kick=0.5", text);
  }
  return weight;
}

absl::StatusOr<WeightKeyframe> ParseKeyframe(absl::string_view text) {
  constexpr char kForm[] = "FRAME:CLASS=WEIGHT,... such as 30:kick=1,hug=0";
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits(':', 1));
  WeightKeyframe keyframe;
  if (!absl::SimpleAtoi(parts.first, &keyframe.frame) || keyframe.frame < 0) {
    return Expected(kForm, text);
  }
  for (const absl::string_view item : absl::StrSplit(parts.second, ',')) {
    absl::StatusOr<ClassWeight> weight = ParseClassWeight(item);
    if (!weight.ok()) return Expected(kForm, text);
    keyframe.weights.push_back(*std::move(weight));
  }
  return keyframe;
}

absl::StatusOr<SynthesisRequest> ReadRequestFile(const std::filesystem::path& file) {
  const absl::StatusOr<std::string> text =
      base::ReadFile(file, motion::kMaxMotionFileBytes, "a request");
  if (!text.ok()) return text.status();
  v1::SynthesizeRequest message;
  const absl::Status parsed =
      messages::ParseMessage(*text, messages::MessageSyntax::kTextFormat, &message);
  if (!parsed.ok()) return InFile(file, parsed);
  absl::StatusOr<SynthesisRequest> request = FromProto(message);
  if (!request.ok()) return InFile(file, request.status());
  return request;
}

absl::StatusOr<PreparedCall> PrepareCall(
    const ReactionArguments& arguments, const ServerArguments& server,
    const std::function<absl::Status(const SynthesisRequest&)>& check,
    const ProgramEnvironment& environment) {
  absl::Status status = CheckInputs(arguments);
  if (!status.ok()) return status;
  absl::StatusOr<SynthesisRequest> request = StartRequest(arguments);
  if (!request.ok()) return request.status();
  status = check(*request);
  if (!status.ok()) return status;
  absl::StatusOr<Client> client = Connect(server, environment);
  if (!client.ok()) return client.status();
  absl::StatusOr<ModelDetails> details = client->GetModel(request->model);
  if (!details.ok()) return details.status();
  absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
  if (!skeleton.ok()) return skeleton.status();
  return PreparedCall{*std::move(request), *std::move(client), details->model.samples,
                      *std::move(skeleton)};
}

absl::Status ReadMotions(const ReactionArguments& arguments, const motion::Skeleton& skeleton,
                         SynthesisRequest* request, std::vector<std::string>* notes) {
  const absl::StatusOr<formats::ReadOptions> options = ToReadOptions(arguments.input, skeleton);
  if (!options.ok()) return options.status();
  if (!arguments.follower_start.empty()) {
    formats::ReadOptions reading = *options;
    reading.format = std::nullopt;  // describes the leader
    absl::StatusOr<FollowerStart> start = batch::ReadStart(
        arguments.follower_start, arguments.leader, arguments.leader_side, std::move(reading));
    if (!start.ok()) return start.status();
    request->follower_start = *std::move(start);
  }
  if (arguments.leader.empty()) return absl::OkStatus();
  return ReadLeader(arguments, *options, request, notes);
}

}  // namespace duet::client::cli
