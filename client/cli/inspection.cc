#include "client/cli/inspection.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/counted.h"
#include "model/base/printable.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using nlohmann::json;
using retargeting::JointReading;
using retargeting::Setting;

constexpr std::size_t kMostNames = 12;

// Empty if reading ended before this was known.
std::string DescribeSetting(const char* name, const std::optional<Setting>& setting,
                            const Style& style) {
  if (!setting.has_value()) return "";
  std::string origin(OriginName(setting->origin));
  if (!setting->why.empty()) absl::StrAppend(&origin, ": ", base::EscapeControls(setting->why));
  return absl::StrFormat("  %-11s %s  %s\n", name, base::EscapeControls(setting->value),
                         style.Faint(absl::StrCat("(", origin, ")")));
}

// "Spine1", or "0.50 Head + 0.50 HeadTop".
std::string DescribeParts(const std::vector<JointReading::Part>& parts) {
  if (parts.size() == 1 && parts[0].weight == 1) return base::EscapeControls(parts[0].name);
  return absl::StrJoin(parts, " + ", [](std::string* out, const JointReading::Part& part) {
    absl::StrAppendFormat(out, "%.2f %s", static_cast<double>(part.weight),
                          base::EscapeControls(part.name));
  });
}

std::string DescribeJoints(const std::vector<JointReading>& joints, const Style& style) {
  std::string text = "  joints\n";
  for (const JointReading& joint : joints) {
    absl::StrAppendFormat(&text, "    %-15s ", joint.joint);
    if (joint.parts.empty()) {
      absl::StrAppend(&text, style.Bad("missing"), "\n");
      continue;
    }
    absl::StrAppend(&text, DescribeParts(joint.parts));
    const std::string why = joint.origin == retargeting::Origin::kGiven ? "given" : joint.why;
    if (!why.empty()) {
      absl::StrAppend(&text, "  ", style.Faint(absl::StrCat("(", base::EscapeControls(why), ")")));
    }
    text += "\n";
  }
  return text;
}

// Joints of the file that are not used.
std::vector<std::string> Unused(const retargeting::ReadingReport& report) {
  std::vector<std::string> unused;
  for (const std::string& name : report.file_joints) {
    const auto uses = [&name](const JointReading& joint) {
      return std::any_of(joint.parts.begin(), joint.parts.end(),
                         [&name](const JointReading::Part& part) { return part.name == name; });
    };
    if (std::none_of(report.joints.begin(), report.joints.end(), uses)) unused.push_back(name);
  }
  return unused;
}

std::string DescribeUnused(const retargeting::ReadingReport& report) {
  const std::vector<std::string> unused = Unused(report);
  if (unused.empty() || report.joints.empty()) return "";
  const std::size_t shown = std::min(unused.size(), kMostNames);
  const std::vector<std::string> some(unused.begin(),
                                      unused.begin() + static_cast<std::ptrdiff_t>(shown));
  return absl::StrCat(
      "    not used: ", base::EscapeControls(absl::StrJoin(some, ", ")),
      shown < unused.size() ? absl::StrCat(" and ", unused.size() - shown, " more") : "", "\n");
}

std::string DescribeReading(const retargeting::ReadingReport& report, const Style& style) {
  std::string text = absl::StrCat(DescribeSetting("frame rate", report.frame_rate, style),
                                  DescribeSetting("unit", report.unit, style),
                                  DescribeSetting("up axis", report.up_axis, style));
  for (const std::string& remark : report.remarks) {
    absl::StrAppend(&text, "  ", style.Warning(base::EscapeControls(remark)), "\n");
  }
  if (!report.joints.empty()) absl::StrAppend(&text, DescribeJoints(report.joints, style));
  return text + DescribeUnused(report);
}

std::string DescribeChecks(const std::vector<analysis::Check>& checks, const Style& style) {
  std::string text = "  skeleton\n";
  for (const analysis::Check& check : checks) {
    absl::StrAppendFormat(&text, "    %s %-13s %s\n",
                          check.good ? style.Good("ok  ") : style.Warning("look"), check.name,
                          check.text);
  }
  return text;
}

std::string DescribeLength(const motion::Clip& clip) {
  const int frames = clip.frame_count();
  std::string text = base::Counted(frames, "frame");
  if (clip.frame_rate_hz > 0) {
    absl::StrAppendFormat(&text, ", %.2f s at %g Hz", frames / clip.frame_rate_hz,
                          clip.frame_rate_hz);
  }
  return text;
}

// Empty if both people have the same number of frames.
std::string DescribeUnlikeLength(const motion::Clip& first, const motion::Clip& second,
                                 const Style& style) {
  if (second.frame_count() == 0 || (second.frame_count() == first.frame_count() &&
                                    second.frame_rate_hz == first.frame_rate_hz)) {
    return "";
  }
  return absl::StrCat("  length      ", DescribeLength(second), "  ",
                      style.Warning("unlike the other: each can be read alone, not both"), "\n");
}

std::string DescribePeople(int people) {
  return absl::StrCat(base::Counted(people, "person", "people"),
                      people > 2 ? " (the first two are read)" : "");
}

json SettingJson(const std::optional<Setting>& setting) {
  if (!setting.has_value()) return nullptr;
  json object = {{"value", setting->value}, {"origin", std::string(OriginName(setting->origin))}};
  if (!setting->why.empty()) object["why"] = setting->why;
  return object;
}

json JointJson(const JointReading& joint) {
  json parts = json::array();
  for (const JointReading::Part& part : joint.parts) {
    parts.push_back({{"joint", part.name}, {"weight", part.weight}});
  }
  json object = {{"joint", joint.joint},
                 {"parts", parts},
                 {"origin", parts.empty() ? "missing" : std::string(OriginName(joint.origin))}};
  if (!joint.why.empty()) object["why"] = joint.why;
  return object;
}

json PersonJson(const InspectedPerson& person) {
  json joints = json::array(), checks = json::array(), missing = json::array();
  for (const JointReading& joint : person.report.joints) {
    joints.push_back(JointJson(joint));
    if (joint.parts.empty()) missing.push_back(joint.joint);
  }
  for (const analysis::Check& check : person.checks) {
    checks.push_back({{"name", check.name},
                      {"good", check.good},
                      {"text", check.text},
                      {"figures", check.figures}});
  }
  return {{"frame_rate", SettingJson(person.report.frame_rate)},
          {"unit", SettingJson(person.report.unit)},
          {"up_axis", SettingJson(person.report.up_axis)},
          {"remarks", person.report.remarks},
          {"file_joints", person.report.file_joints},
          {"unused_joints", Unused(person.report)},
          {"joints", joints},
          {"missing_joints", missing},
          {"checks", checks}};
}

}  // namespace

std::string DescribeVertical(const motion::VerticalEstimate& vertical) {
  std::string text = Describe(vertical);
  if (vertical.verdict == motion::TiltVerdict::kTilted) {
    absl::StrAppendFormat(&text, "; --level %.3f,%.3f,%.3f", vertical.up.x, vertical.up.y,
                          vertical.up.z);
  }
  if (vertical.places == 0) return absl::StrCat(text, "; no foot rests in several places");
  return absl::StrCat(text, "; feet rest in ", base::Counted(vertical.places, "place"));
}

json VerticalJson(const motion::VerticalEstimate& vertical) {
  return {{"verdict", std::string(VerdictName(vertical.verdict))},
          {"text", Describe(vertical)},
          {"up", {vertical.up.x, vertical.up.y, vertical.up.z}},
          {"tilt_degrees", vertical.tilt_degrees},
          {"error_degrees", vertical.error_degrees},
          {"deviations", vertical.deviations},
          {"disagreement", vertical.disagreement},
          {"places", vertical.places}};
}

std::string DescribeInspection(const Inspection& inspection, const Style& style) {
  std::string text = style.Heading(base::EscapeControls(inspection.file));
  const retargeting::ReadingReport& first = inspection.people[0].report;
  if (!first.format.empty()) absl::StrAppend(&text, ": ", first.format);
  if (first.people > 0) absl::StrAppend(&text, ", ", DescribePeople(first.people));
  const motion::Clip& clip = inspection.people[0].clip;
  if (clip.frame_count() > 0) absl::StrAppend(&text, ", ", DescribeLength(clip));
  text += "\n";
  if (clip.frame_count() > 0 && !first.frame_rate.has_value()) {
    absl::StrAppend(&text, "  frame rate  ", style.Warning("unknown; say it with --frame-rate HZ"),
                    "\n");
  }
  for (std::size_t i = 0; i < inspection.people.size(); ++i) {
    const InspectedPerson& person = inspection.people[i];
    if (inspection.people.size() > 1) {
      absl::StrAppend(&text, style.Heading(i == 0 ? "  left person" : "  right person"), "\n",
                      i == 0 ? "" : DescribeUnlikeLength(clip, person.clip, style));
    }
    const std::string reading = DescribeReading(person.report, style);
    const bool repeated = i > 0 && reading == DescribeReading(first, style);
    absl::StrAppend(&text, repeated ? "  read as the other\n" : reading);
    if (!person.checks.empty()) absl::StrAppend(&text, DescribeChecks(person.checks, style));
  }
  if (inspection.vertical) {
    absl::StrAppend(&text, "  tilt        ", DescribeVertical(*inspection.vertical), "\n");
  }
  if (!inspection.status.ok()) {
    absl::StrAppend(&text, "  ", style.Bad("cannot be read"), ": ", inspection.status.message(),
                    "\n");
  }
  return text;
}

json InspectionJson(const Inspection& inspection) {
  const InspectedPerson& first = inspection.people[0];
  json people = json::array();
  for (const InspectedPerson& person : inspection.people) people.push_back(PersonJson(person));
  json object = {{"file", inspection.file},
                 {"readable", inspection.status.ok()},
                 {"format", first.report.format},
                 {"people_count", first.report.people},
                 {"people", people}};
  if (!inspection.status.ok()) {
    object["error"] = inspection.status.message();
    return object;
  }
  if (inspection.vertical) object["tilt"] = VerticalJson(*inspection.vertical);
  object["frames"] = first.clip.frame_count();
  if (first.clip.frame_rate_hz > 0) {
    object["frame_rate_hz"] = first.clip.frame_rate_hz;
    object["seconds"] = first.clip.frame_count() / first.clip.frame_rate_hz;
  }
  return object;
}

}  // namespace duet::client::cli
