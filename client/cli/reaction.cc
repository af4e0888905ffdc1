#include "client/cli/reaction.h"

#include <algorithm>
#include <limits>
#include <system_error>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cli/flags.h"
#include "client/cli/request_file.h"
#include "model/base/nearest.h"
#include "model/base/program_flags.h"
#include "model/base/text.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/vertical.h"

namespace duet::client::cli {
namespace {

// The heights of a root joint, as shares of the leader's leg, of a person who sits or leaps.
constexpr double kLowestRoot = 0.3, kHighestRoot = 1.6;

absl::Status Expected(absl::string_view expected, absl::string_view text) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(text)));
}

absl::StatusOr<float> ParseVariety(absl::string_view text) {
  float variety = 0;
  if (absl::SimpleAtof(text, &variety) && variety >= 0 && variety <= 2) return variety;
  return Expected("a number from 0 to 2", text);
}

// In the leader's own file, the follower is the other person.
formats::Side FollowerStartSide(const ReactionArguments& arguments) {
  std::error_code error;
  if (!std::filesystem::equivalent(arguments.follower_start, arguments.leader, error)) {
    return kDefaultSide;
  }
  return batch::OtherSide(arguments.leader_side);
}

absl::StatusOr<FollowerStart> ReadStart(const ReactionArguments& arguments,
                                        formats::ReadOptions options) {
  if (const auto root = batch::ParsePoint(arguments.follower_start)) return FollowerStart(*root);
  options.format = std::nullopt;  // describes the leader
  options.side = FollowerStartSide(arguments);
  absl::StatusOr<std::vector<motion::Vec3>> pose =
      ReadFollowerStart(arguments.follower_start, options);
  if (!pose.ok()) return pose.status();
  return FollowerStart(*std::move(pose));
}

// Warns of a start on the floor, such as 0,0,1.2, or in the air: it is the place of the root joint.
void WarnOfHeight(const FollowerStart& start, const motion::Clip& leader,
                  const motion::Skeleton& skeleton, std::vector<std::string>* notes) {
  const motion::Vec3* root = std::get_if<motion::Vec3>(&start);
  if (root == nullptr || notes == nullptr || !skeleton.feet) return;
  float floor = std::numeric_limits<float>::max();
  for (int frame = 0; frame < leader.frame_count(); ++frame) {
    for (const int foot : {skeleton.feet->left, skeleton.feet->right}) {
      floor = std::min(floor, leader.at(frame, foot).y);
    }
  }
  const double leg = LegLength(skeleton, leader.poses);
  const double height = static_cast<double>(root->y - floor);
  if (height >= kLowestRoot * leg && height <= kHighestRoot * leg) return;
  notes->push_back(
      absl::StrFormat("warning: --follower-start: expected Y near %.2f m, where the %s of a "
                      "standing person is, got %g: it is a place of that joint, not of the floor",
                      static_cast<double>(floor) + leg,
                      skeleton.joint_names[static_cast<std::size_t>(skeleton.root)], root->y));
}

// Everybody whom the camera captured: the leader and, in a file with two people, the other person.
motion::VerticalEstimate EstimateVertical(const motion::Clip& leader, const MotionInput& input,
                                          formats::ReadOptions options, int people) {
  motion::VerticalEvidence evidence(options.skeleton);
  evidence.Add(leader);
  if (people >= 2) {
    options.side = batch::OtherSide(options.side);
    options.notes = nullptr;
    options.report = nullptr;
    const absl::StatusOr<motion::Clip> other = input.Read(options);
    if (other.ok()) evidence.Add(*other);
  }
  return evidence.Estimate();
}

absl::Status ReadLeader(const ReactionArguments& arguments, formats::ReadOptions options,
                        std::istream* in, SynthesisRequest* request,
                        std::vector<std::string>* notes) {
  const absl::StatusOr<MotionInput> input = MotionInput::Open(arguments.leader, in);
  if (!input.ok()) return input.status();
  retargeting::ReadingReport report;
  options.side = arguments.leader_side;
  options.notes = notes;
  options.report = &report;
  absl::StatusOr<motion::Clip> leader = input->Read(options);
  if (!leader.ok()) return leader.status();
  request->leader = *std::move(leader);
  if (request->up) return absl::OkStatus();
  const motion::VerticalEstimate vertical =
      EstimateVertical(request->leader, *input, options, report.people);
  const bool tilted = vertical.verdict == motion::TiltVerdict::kTilted;
  if (tilted) request->up = vertical.up;
  if (notes != nullptr) {
    notes->push_back(absl::StrCat(tilted ? "levelled: " : "not levelled: ", Describe(vertical)));
  }
  return absl::OkStatus();
}

}  // namespace

void AddReactionFlags(CLI::App* app, ReactionArguments* arguments) {
  app->add_option("--request", arguments->request,
                  "File with a request: the protobuf message duet.v1.SynthesizeRequest in text "
                  "format, with fields that have no flag too; flags override it")
      ->type_name("FILE")
      ->group(kReactionGroup);
  CLI::Option* label =
      AddParsedList(app, "--label", "CLASS[=WEIGHT]", ParseClassWeight, &arguments->weights,
                    "Weight of an interaction class, such as kick=1 or hug=-0.5; repeatable")
          ->group(kReactionGroup);
  AddParsedList(app, "--keyframe", "FRAME:CLASS[=WEIGHT],...", ParseKeyframe, &arguments->keyframes,
                "Weights from a frame on, for weights that change over time; repeatable")
      ->excludes(label)
      ->group(kReactionGroup);
  AddParsed(app, "--model", "NAME[@VERSION|:LABEL]", ParseModelChoice, &arguments->model,
            "Model to use (default: the server's default model)")
      ->group(kReactionGroup);
  app->add_option("--follower-start", arguments->follower_start,
                  "Start of the follower: a motion file (its first frame), or X,Y,Z of the root "
                  "joint in metres, y up; Y is about 1 above the floor for a person who stands")
      ->type_name("FILE|X,Y,Z")
      ->group(kReactionGroup);
  AddParsed(app, "--seed", "SEED", ParseSeed, &arguments->seed,
            "Seed of a model that samples; the same seed gives the same answer (default: derived "
            "from the leader; a typical one in live sessions)")
      ->group(kReactionGroup);
  AddParsed(app, "--variety", "VARIETY", ParseVariety, &arguments->variety,
            "Variety of the answers of such a model: 0 typical, 1 as varied as people, at most 2 "
            "(default: 1)")
      ->group(kReactionGroup);
  app->add_option(
         "--candidates", arguments->candidates,
         "Samples that such a model draws for each window, from which the best becomes the "
         "answer; higher values take longer (default: 1)")
      ->check(base::InRange(1, 16))
      ->type_name("COUNT")
      ->group(kReactionGroup);
}

void AddLeaderFlags(CLI::App* app, ReactionArguments* arguments) {
  AddChoice(app, "--leader-side", kSides, &arguments->leader_side,
            "The person who leads in a file with two people")
      ->default_str(NameOf(kSides, arguments->leader_side))
      ->group(kInputGroup);
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

absl::Status CheckInputs(const ReactionArguments& arguments) {
  absl::Status status = ReadJoints(arguments.input.joint_map).status();
  if (status.ok() && !arguments.leader.empty()) {
    status = CheckInput(arguments.leader, arguments.input.format);
  }
  const std::string& start = arguments.follower_start;
  if (!status.ok() || start.empty() || batch::ParsePoint(start).has_value()) return status;
  status = CheckInput(start, std::nullopt);
  if (!absl::IsNotFound(status)) return status;
  return absl::NotFoundError(
      absl::StrCat("--follower-start: ", status.message(), "; expected a motion file or X,Y,Z"));
}

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

absl::Status CheckLabels(const SynthesisRequest& request, const ModelInfo& model) {
  std::vector<ClassWeight> weights = request.weights;
  for (const WeightKeyframe& keyframe : request.keyframes) {
    weights.insert(weights.end(), keyframe.weights.begin(), keyframe.weights.end());
  }
  const std::vector<std::string>& known = model.interaction_classes;
  for (const ClassWeight& weight : weights) {
    const std::string& name = weight.interaction_class;
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(request.keyframes.empty() ? "label" : "keyframe", ": class: expected one of ",
                     model.name, " (", absl::StrJoin(known, ", "), "), got ", base::Quoted(name),
                     base::DidYouMean(name, known)));
  }
  return absl::OkStatus();
}

absl::Status ReadMotions(const ReactionArguments& arguments, const motion::Skeleton& skeleton,
                         std::istream* in, SynthesisRequest* request,
                         std::vector<std::string>* notes) {
  const absl::StatusOr<formats::ReadOptions> options = ToReadOptions(arguments.input, skeleton);
  if (!options.ok()) return options.status();
  if (!arguments.follower_start.empty()) {
    absl::StatusOr<FollowerStart> start = ReadStart(arguments, *options);
    if (!start.ok()) return start.status();
    request->follower_start = *std::move(start);
  }
  if (arguments.leader.empty()) return absl::OkStatus();
  const absl::Status status = ReadLeader(arguments, *options, in, request, notes);
  if (status.ok() && request->follower_start && !request->up) {
    WarnOfHeight(*request->follower_start, request->leader, skeleton, notes);
  }
  return status;
}

}  // namespace duet::client::cli
