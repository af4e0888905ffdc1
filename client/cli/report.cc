#include "client/cli/report.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/exit_code.h"
#include "client/cli/grade_report.h"
#include "client/cli/pin_report.h"
#include "client/error_details.h"
#include "model/base/counted.h"
#include "model/motion/reading_setting.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;

// Held-out captured leaders rarely exceed this.
constexpr double kFarUnfamiliarity = 1.5;

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

std::string DescribeModel(const ModelInfo& model) {
  std::string text = absl::StrCat(model.name, "@", model.version);
  if (!model.version_labels.empty()) {
    absl::StrAppend(&text, " (", absl::StrJoin(model.version_labels, ", "), ")");
  }
  if (model.is_default) absl::StrAppend(&text, ", default");
  absl::StrAppend(&text, "\n  classes   ", absl::StrJoin(model.interaction_classes, ", "));
  absl::StrAppend(&text, "\n  joints    ", model.joint_names.size(), ", root ", model.root_joint);
  absl::StrAppendFormat(&text, "\n  works at  %g Hz in windows of %d frames", model.frame_rate_hz,
                        model.window_frames);
  absl::StrAppend(&text, "\n  follower  ",
                  model.accepts_follower_start ? "may be given a start" : "chooses its own start");
  absl::StrAppend(&text, "\n  answers   ",
                  model.samples ? "vary with --seed and --variety" : "one, whatever the seed");
  if (!model.description.empty()) absl::StrAppend(&text, "\n  about     ", model.description);
  if (!model.terms.empty()) absl::StrAppend(&text, "\n  terms     ", model.terms);
  if (model.free_for_all_uses) {
    absl::StrAppend(&text,
                    "\n  free      anybody may use the model and its output for any purpose");
  }
  return text + "\n";
}

json ModelJson(const ModelInfo& model) {
  json bones = json::array();
  for (const motion::Bone& bone : model.bones) bones.push_back({bone.parent, bone.child});
  return {{"name", model.name},
          {"version", model.version},
          {"version_labels", model.version_labels},
          {"is_default", model.is_default},
          {"interaction_classes", model.interaction_classes},
          {"joint_names", model.joint_names},
          {"bones", bones},
          {"root_joint", model.root_joint},
          {"frame_rate_hz", model.frame_rate_hz},
          {"window_frames", model.window_frames},
          {"accepts_follower_start", model.accepts_follower_start},
          {"samples", model.samples},
          {"description", model.description},
          {"terms", model.terms},
          {"free_for_all_uses", model.free_for_all_uses},
          {"weights_sha256", model.weights_sha256}};
}

// The flag for a setting that a motion file does not state.
std::string FlagFor(motion::ReadingSetting setting) {
  switch (setting) {
    case motion::ReadingSetting::kFormat:
      return "--input-format FORMAT";
    case motion::ReadingSetting::kFrameRate:
      return "--frame-rate HZ";
    case motion::ReadingSetting::kMetresPerUnit:
      return "--metres-per-unit METRES";
    case motion::ReadingSetting::kJointMap:
      return "--joint-map MODEL_JOINT=FILE_JOINT, or a table of them with --joint-map-file FILE";
    case motion::ReadingSetting::kRigJointMap:
      return "--follower-rig-joint-map MODEL_JOINT=RIG_JOINT (in duet convert, --rig-joint-map), "
             "or "
             "a table of them with --follower-rig-joint-map-file FILE";
  }
  return "";
}

std::string Advice(const absl::Status& status, const std::string& server_address) {
  if (std::string advice = DescribeAdvice(status); !advice.empty()) return advice;
  if (ExitCodeFor(status) != kExitRetry) return "";
  // An error reason shows that a Duet server answered.
  if (absl::IsUnavailable(status) && ErrorReason(status).empty()) {
    return absl::StrCat("Start a duet-server at ", server_address,
                        ", or name another one with --server HOST:PORT (and --tls or --tls-ca FILE "
                        "if it encrypts).\n");
  }
  return "Trying again later may help.\n";
}

}  // namespace

std::string Print(const json& value) {
  return value.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string DescribeAdvice(const absl::Status& status) {
  const auto setting = motion::MendingSetting(status);
  return setting.has_value() ? absl::StrCat("Specify it with ", FlagFor(*setting), ".\n") : "";
}

std::string DescribeModels(const std::vector<ModelInfo>& models) {
  if (models.empty()) return "The server serves no model.\n";
  return absl::StrJoin(models, "", [](std::string* out, const ModelInfo& model) {
    out->append(DescribeModel(model));
  });
}

std::string ModelsJson(const std::vector<ModelInfo>& models) {
  json list = json::array();
  for (const ModelInfo& model : models) list.push_back(ModelJson(model));
  return Print({{"models", list}});
}

std::string DescribeRequest(const Synthesis& synthesis, const std::vector<std::string>& notes) {
  const motion::Clip& leader = synthesis.result.pair.leader;
  std::string text;
  absl::StrAppendFormat(&text, "leader    %s: %s, %.2f s at %g Hz\n",
                        synthesis.leader_file.string(),
                        base::Counted(leader.frame_count(), "frame"),
                        leader.frame_count() / leader.frame_rate_hz, leader.frame_rate_hz);
  for (const std::string& note : notes) absl::StrAppend(&text, "          ", note, "\n");
  absl::StrAppend(&text, "reaction  ", DescribeWeights(synthesis.request), "\n");
  return text;
}

std::string DescribeAnswer(const Synthesis& synthesis, const WrittenFiles& written) {
  const SynthesisResult& result = synthesis.result;
  std::string text;
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
  text += DescribePins(synthesis.request.constraints, result.constraint_metres);
  if (result.attempt_count > 1) {
    absl::StrAppend(&text, "          ", base::Counted(result.attempt_count, "attempt"), "\n");
  }
  for (size_t i = 0; i < written.files.size(); ++i) {
    absl::StrAppend(&text, i == 0 ? "wrote     " : "          ", written.files[i].string(), "\n");
  }
  for (const std::string& note : written.notes) absl::StrAppend(&text, "          ", note, "\n");
  return text;
}

json SynthesisJson(const Synthesis& synthesis, const WrittenFiles& written,
                   const std::vector<std::string>& notes) {
  const SynthesisResult& result = synthesis.result;
  const motion::Clip& leader = result.pair.leader;
  json keyframes = json::array();
  for (const WeightKeyframe& keyframe : synthesis.request.keyframes) {
    keyframes.push_back({{"frame", keyframe.frame}, {"weights", WeightsJson(keyframe.weights)}});
  }
  json files = json::array();
  for (const std::filesystem::path& file : written.files) files.push_back(file.string());
  std::vector<std::string> all_notes = notes;
  all_notes.insert(all_notes.end(), written.notes.begin(), written.notes.end());
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
                 {"notes", all_notes},
                 {"files", files}};
  if (const auto& up = synthesis.request.up) object["up"] = {up->x, up->y, up->z};
  if (result.unfamiliarity) object["unfamiliarity"] = *result.unfamiliarity;
  if (result.grade) object["grade"] = GradeJson(*result.grade);
  if (const auto& pins = synthesis.request.constraints; !pins.empty()) {
    object["constraints"] = PinsJson(pins, result.constraint_metres);
  }
  return object;
}

std::string SamplesJson(const std::vector<json>& samples) {
  return Print(samples.size() == 1 ? samples.front() : json{{"samples", samples}});
}

std::string DescribeFailure(const absl::Status& status, const std::string& server_address,
                            const Style& style) {
  const std::string code = absl::StatusCodeToString(status.code());
  const std::vector<FieldViolation> violations = FieldViolations(status);
  if (violations.empty()) {
    return absl::StrCat(style.Bad("duet:"), " ", status.message(), " (", code, ")\n",
                        Advice(status, server_address));
  }
  std::string text =
      absl::StrCat(style.Bad("duet:"), " the server rejects the request (", code, ")\n");
  for (const FieldViolation& violation : violations) {
    absl::StrAppend(&text, "  ", violation.field, violation.field.empty() ? "" : ": ",
                    violation.description, "\n");
  }
  return text + Advice(status, server_address);
}

}  // namespace duet::client::cli
