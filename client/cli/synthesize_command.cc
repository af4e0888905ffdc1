#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/time/time.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/output.h"
#include "client/cli/reaction.h"
#include "client/cli/server.h"
#include "model/base/counted.h"
#include "model/formats/motion_file.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;
using Paths = std::vector<std::filesystem::path>;

struct SynthesizeArguments : ReactionArguments {
  ServerArguments server;
  Paths outputs;
  bool json = false;
  bool quiet = false;
};

// Checks flags that depend on each other.
void CheckTogether(const SynthesizeArguments& arguments) {
  if (arguments.weights.empty() && arguments.keyframes.empty() && arguments.request.empty()) {
    RejectMissing("--label, --keyframe or --request");
  }
  Paths files = arguments.outputs;
  for (const std::filesystem::path& output : arguments.outputs) {
    if (formats::FormatOf(output) != formats::Format::kBvh) continue;
    files.push_back(std::filesystem::path(output).replace_extension(".leader.bvh"));
    files.push_back(std::filesystem::path(output).replace_extension(".follower.bvh"));
  }
  for (const std::filesystem::path& file : files) {
    const absl::Status status =
        CheckOutput(file, {arguments.leader, arguments.follower_start, arguments.request});
    if (!status.ok()) RejectFlag("--out", std::string(status.message()));
  }
}

// Checks what the flags and the request's file decide together, before the first call.
absl::Status CheckRequest(const SynthesizeArguments& arguments, const SynthesisRequest& request) {
  const bool holds_rotations = std::any_of(
      arguments.outputs.begin(), arguments.outputs.end(), [](const std::filesystem::path& output) {
        return formats::FormatOf(output) == formats::Format::kJson;
      });
  if (!request.rotations || holds_rotations) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "reply_rotations: expected --out FILE.json, which holds them, got only other outputs");
}

absl::StatusOr<Paths> WriteAll(const Paths& outputs, const Synthesis& synthesis) {
  Paths written;
  for (const std::filesystem::path& output : outputs) {
    const absl::StatusOr<Paths> files = WriteOutput(output, synthesis);
    if (!files.ok()) return NotWritten(files.status());
    written.insert(written.end(), files->begin(), files->end());
  }
  return written;
}

// Held-out captured leaders rarely exceed this.
constexpr double kFarUnfamiliarity = 1.5;
constexpr std::size_t kMaxRunsShown = 5;

std::string Milliseconds(absl::Duration duration) {
  return absl::StrFormat("%.0f ms", absl::ToDoubleMilliseconds(duration));
}

std::string Join(const std::vector<ClassWeight>& weights) {
  return absl::StrJoin(weights, ", ", [](std::string* out, const ClassWeight& weight) {
    absl::StrAppend(out, weight.interaction_class, " ", weight.weight);
  });
}

std::string DescribeWeights(const SynthesisRequest& request) {
  if (request.keyframes.empty()) return Join(request.weights);
  return absl::StrJoin(request.keyframes, "; ", [](std::string* out, const WeightKeyframe& key) {
    absl::StrAppend(out, "at frame ", key.frame, " ", Join(key.weights));
  });
}

json WeightsJson(const std::vector<ClassWeight>& weights) {
  json object = json::object();
  for (const ClassWeight& weight : weights) object[weight.interaction_class] = weight.weight;
  return object;
}

double Rounded(double share) { return std::round(share * 1e6) / 1e6; }

std::string Frames(const FrameRun& run) {
  const int last = run.first_frame + run.frame_count - 1;
  return last == run.first_frame ? absl::StrCat(last) : absl::StrCat(run.first_frame, "-", last);
}

std::string BadFrames(const std::vector<FrameRun>& runs) {
  const std::size_t shown = std::min(runs.size(), kMaxRunsShown);
  std::vector<std::string> frames;
  for (std::size_t i = 0; i < shown; ++i) frames.push_back(Frames(runs[i]));
  return absl::StrCat(absl::StrJoin(frames, ", "), shown < runs.size() ? ", ..." : "");
}

// "< 1 %" if it would round to 0 %, which only a share of 0 is.
std::string Percent(double share) {
  return share > 0 && share < 0.005 ? "< 1 %" : absl::StrFormat("%.0f %%", 100 * share);
}

std::string DescribeGrade(const MotionGrade& grade) {
  std::string text = absl::StrFormat(
      "          graded: twisted %s, both feet move %s (leader %s), overlapping %s\n",
      Percent(grade.twisted), Percent(grade.skating), Percent(grade.leader_skating),
      Percent(grade.overlapping));
  if (!grade.bad_runs.empty()) {
    absl::StrAppend(&text, "          twisted or overlapping in frames ", BadFrames(grade.bad_runs),
                    "\n");
  }
  return text;
}

json GradeJson(const MotionGrade& grade) {
  json runs = json::array();
  for (const FrameRun& run : grade.bad_runs) {
    runs.push_back({{"first_frame", run.first_frame}, {"frame_count", run.frame_count}});
  }
  return {{"twisted", Rounded(grade.twisted)},
          {"skating", Rounded(grade.skating)},
          {"leader_skating", Rounded(grade.leader_skating)},
          {"overlapping", Rounded(grade.overlapping)},
          {"bad_runs", runs}};
}

json PinsJson(const std::vector<JointConstraint>& pins, const std::vector<float>& metres) {
  json list = json::array();
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const JointConstraint& pin = pins[i];
    list.push_back({{"joint_name", pin.joint},
                    {"frame", pin.frame},
                    {"position", {pin.position.x, pin.position.y, pin.position.z}},
                    {"softness", pin.softness}});
    if (i < metres.size()) list.back()["remaining_metres"] = metres[i];
  }
  return list;
}

// The request and the answer. `notes`: on how the leader was read.
std::string DescribeSynthesis(const Synthesis& synthesis, const Paths& written,
                              const std::vector<std::string>& notes) {
  const SynthesisResult& result = synthesis.result;
  const motion::Clip& leader = synthesis.result.pair.leader;
  std::string text;
  absl::StrAppendFormat(&text, "leader    %s: %s, %.2f s at %g Hz\n",
                        synthesis.leader_file.string(),
                        base::Counted(leader.frame_count(), "frame"),
                        leader.frame_count() / leader.frame_rate_hz, leader.frame_rate_hz);
  for (const std::string& note : notes) absl::StrAppend(&text, "          ", note, "\n");
  absl::StrAppend(&text, "reaction  ", DescribeWeights(synthesis.request), "\n");
  absl::StrAppendFormat(&text, "follower  from %s@%d in %s, first frames after %s (%s, %s)\n",
                        result.model_name, result.model_version, Milliseconds(result.timings.total),
                        Milliseconds(result.timings.first_chunk),
                        base::Counted(result.window_count, "window"),
                        absl::StrCat(Milliseconds(result.timings.compute), " in the network"));
  std::vector<std::string> settings;
  if (synthesis.sampled) {
    settings.push_back(absl::StrCat("seed ", result.seed, ", variety ", result.variety));
    if (result.candidates > 1) {
      settings.push_back(absl::StrCat("best of ", result.candidates, " candidates"));
    }
  }
  if (result.cleaned_up) settings.push_back("cleaned up");
  if (!settings.empty()) {
    absl::StrAppend(&text, "          ", absl::StrJoin(settings, ", "), "\n");
  }
  if (result.unfamiliarity) {
    absl::StrAppendFormat(&text,
                          "          unfamiliarity %.2f (1: as the farthest tenth of the training "
                          "leaders)\n",
                          *result.unfamiliarity);
    if (*result.unfamiliarity > kFarUnfamiliarity) {
      absl::StrAppend(
          &text,
          "          the leader differs from those that the model was trained on: check the "
          "answer before you use it\n");
    }
  }
  if (result.grade) text += DescribeGrade(*result.grade);
  if (const auto& metres = result.constraint_metres; !metres.empty()) {
    absl::StrAppendFormat(&text, "          pins: at most %.1f cm away\n",
                          100 * double{*std::max_element(metres.begin(), metres.end())});
  }
  if (result.attempt_count > 1) {
    absl::StrAppend(&text, "          ", base::Counted(result.attempt_count, "attempt"), "\n");
  }
  for (size_t i = 0; i < written.size(); ++i) {
    absl::StrAppend(&text, i == 0 ? "wrote     " : "          ", written[i].string(), "\n");
  }
  return text;
}

json SynthesisJson(const Synthesis& synthesis, const Paths& written,
                   const std::vector<std::string>& notes) {
  const SynthesisResult& result = synthesis.result;
  const motion::Clip& leader = result.pair.leader;
  json keyframes = json::array();
  for (const WeightKeyframe& keyframe : synthesis.request.keyframes) {
    keyframes.push_back({{"frame", keyframe.frame}, {"weights", WeightsJson(keyframe.weights)}});
  }
  json files = json::array();
  for (const std::filesystem::path& file : written) files.push_back(file.string());
  json object = {{"model", {{"name", result.model_name}, {"version", result.model_version}}},
                 {"leader", synthesis.leader_file.string()},
                 {"frames", leader.frame_count()},
                 {"frame_rate_hz", leader.frame_rate_hz},
                 {"weights", WeightsJson(synthesis.request.weights)},
                 {"keyframes", keyframes},
                 {"seed", result.seed},
                 {"variety", result.variety},
                 {"candidates", result.candidates},
                 {"cleaned_up", result.cleaned_up},
                 {"windows", result.window_count},
                 {"attempts", result.attempt_count},
                 {"request_id", result.request_id},
                 {"seconds",
                  {{"first_chunk", absl::ToDoubleSeconds(result.timings.first_chunk)},
                   {"total", absl::ToDoubleSeconds(result.timings.total)},
                   {"queue", absl::ToDoubleSeconds(result.timings.queue)},
                   {"compute", absl::ToDoubleSeconds(result.timings.compute)}}},
                 {"notes", notes},
                 {"files", files}};
  if (const auto& up = synthesis.request.up) object["up"] = {up->x, up->y, up->z};
  if (result.unfamiliarity) object["unfamiliarity"] = *result.unfamiliarity;
  if (result.grade) object["grade"] = GradeJson(*result.grade);
  if (const auto& pins = synthesis.request.constraints; !pins.empty()) {
    object["constraints"] = PinsJson(pins, result.constraint_metres);
  }
  return object;
}

absl::Status RunSynthesize(const SynthesizeArguments& arguments,
                           const ProgramEnvironment& environment) {
  const auto check = [&arguments](const SynthesisRequest& request) {
    return CheckRequest(arguments, request);
  };
  absl::StatusOr<PreparedCall> call = PrepareCall(arguments, arguments.server, check, environment);
  if (!call.ok()) return call.status();
  std::vector<std::string> notes;  // on how the leader was read
  const absl::Status status = ReadMotions(arguments, call->skeleton, &call->request, &notes);
  if (!status.ok()) return status;
  absl::StatusOr<SynthesisResult> result = call->client.Synthesize(call->request);
  if (!result.ok()) return result.status();
  const Synthesis synthesis{std::move(call->request), *std::move(result), call->skeleton,
                            arguments.leader, call->samples};
  const absl::StatusOr<Paths> written = WriteAll(arguments.outputs, synthesis);
  if (!written.ok()) return written.status();
  if (arguments.quiet) return absl::OkStatus();
  *environment.out << (arguments.json ? Print(SynthesisJson(synthesis, *written, notes))
                                      : DescribeSynthesis(synthesis, *written, notes));
  return absl::OkStatus();
}

void AddFlags(CLI::App* app, SynthesizeArguments* arguments) {
  AddValue(app, kInputGroup, "--leader", "FILE", &arguments->leader,
           absl::StrCat("Motion of the leader: ", formats::kReadableExtensions))
      ->required();
  AddLeaderFlags(app, arguments);
  AddReactionFlags(app, arguments);
  AddValue(app, kOutputGroup, "--out", "FILE", &arguments->outputs,
           absl::StrCat("File to write: .html (a page to watch), ", formats::kWritableExtensions,
                        ", of which .bvh makes two files; repeatable"))
      ->required()
      ->allow_extra_args(false);
  AddSummaryFlags(app, kOutputGroup, &arguments->json, &arguments->quiet);
  AddServerFlags(app, &arguments->server);
  app->footer(kExitCodesFooter);
  app->callback([arguments] { CheckTogether(*arguments); });
}

}  // namespace

Command AddSynthesizeCommand(CLI::App* program) {
  const auto arguments = std::make_shared<SynthesizeArguments>();
  CLI::App* app = program->add_subcommand("synthesize", "Synthesise the follower of a leader");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunSynthesize);
}

}  // namespace duet::client::cli
