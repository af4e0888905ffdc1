#include "client/cli/summary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/time/time.h"
#include "client/cli/report.h"
#include "model/base/counted.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;

// Held-out captured leaders rarely exceed this.
constexpr double kFarUnfamiliarity = 1.5;
constexpr std::size_t kMaxRunsShown = 5;
// A pin that is nearer than this is reported as reached.
constexpr float kReachedMetres = 0.01f;

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

std::string DescribePins(const std::vector<JointConstraint>& pins,
                         const std::vector<float>& metres) {
  std::vector<std::string> parts;
  std::size_t reached = 0;
  for (std::size_t i = 0; i < std::min(pins.size(), metres.size()); ++i) {
    if (metres[i] < kReachedMetres) {
      ++reached;
    } else {
      parts.push_back(absl::StrFormat("%s in frame %d is %.1f cm away", pins[i].joint,
                                      pins[i].frame, 100 * double{metres[i]}));
    }
  }
  if (reached > 0) parts.insert(parts.begin(), absl::StrCat(reached, " reached"));
  if (parts.empty()) return "";
  return absl::StrCat("          pins: ", absl::StrJoin(parts, ", "), "\n");
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

std::string Describe(const live::Latencies& latency) {
  return absl::StrFormat("p50 %.1f ms, p99 %.1f ms", absl::ToDoubleMilliseconds(latency.p50),
                         absl::ToDoubleMilliseconds(latency.p99));
}

// What went wrong, in words; empty if nothing did.
std::string DescribeLosses(const live::LiveTotals& totals) {
  std::vector<std::string> parts;
  if (totals.gap_frames > 0) {
    parts.push_back(
        absl::StrCat(base::Counted(totals.gap_frames, "missing leader frame"), " interpolated"));
  }
  if (totals.late_frames > 0) {
    parts.push_back(
        absl::StrCat(base::Counted(totals.late_frames, "late leader frame"), " dropped"));
  }
  if (totals.skipped_frames > 0) {
    parts.push_back(absl::StrCat(base::Counted(totals.skipped_frames, "follower frame"),
                                 " from an older plan, because the server could not keep up"));
  }
  return absl::StrJoin(parts, "; ");
}

}  // namespace

std::string DescribeSynthesis(const Synthesis& synthesis, const WrittenFiles& written,
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

std::string DescribeLive(const live::LiveReport& report) {
  const live::LiveTotals& totals = report.totals;
  std::string text;
  for (const std::string& note : report.notes) absl::StrAppend(&text, "note      ", note, "\n");
  absl::StrAppend(&text, "model     ", report.info.model_name, "@", report.info.model_version,
                  ", seed ", report.info.seed, ", delay ",
                  base::Counted(report.info.delay_frames, "frame"), "\n");
  absl::StrAppendFormat(&text, "live      %.1f s, %d follower frames at %g Hz\n",
                        absl::ToDoubleSeconds(totals.time), totals.frames, report.frame_rate_hz);
  absl::StrAppend(&text, "latency   ", Describe(totals.latency), "\n");
  const std::string losses = DescribeLosses(totals);
  if (!losses.empty()) absl::StrAppend(&text, "losses    ", losses, "\n");
  if (totals.resumed > 0) {
    absl::StrAppend(&text, "resumed   ", base::Counted(totals.resumed, "time"),
                    ", without losing a frame\n");
  }
  for (const std::string& line : report.written) absl::StrAppend(&text, "wrote     ", line, "\n");
  return text;
}

std::string LiveJson(const live::LiveReport& report) {
  const live::LiveTotals& totals = report.totals;
  return Print({{"model", report.info.model_name},
                {"model_version", report.info.model_version},
                {"seed", report.info.seed},
                {"variety", report.info.variety},
                {"candidates", report.info.candidates},
                {"cleaned_up", report.info.cleaned_up},
                {"delay_frames", report.info.delay_frames},
                {"request_id", report.info.request_id},
                {"frame_rate_hz", report.frame_rate_hz},
                {"seconds", absl::ToDoubleSeconds(totals.time)},
                {"leader_frames", report.leader_frames},
                {"follower_frames", totals.frames},
                {"gap_frames", totals.gap_frames},
                {"late_frames", totals.late_frames},
                {"skipped_frames", totals.skipped_frames},
                {"resumed", totals.resumed},
                {"latency_ms",
                 {{"p50", absl::ToDoubleMilliseconds(totals.latency.p50)},
                  {"p99", absl::ToDoubleMilliseconds(totals.latency.p99)}}},
                {"notes", report.notes},
                {"written", report.written}});
}

}  // namespace duet::client::cli
