#include "client/cli/comparison_report.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/viewer/gallery.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using analysis::Displacement;
using analysis::Figure;
using nlohmann::json;

constexpr int kNameColumns = 16;

// Shares in percent, degrees with one decimal, other values with three.
std::string Shown(const std::optional<double>& value, const std::string& unit) {
  if (!value.has_value()) return "-";
  if (unit.empty()) return absl::StrFormat("%.1f %%", 100 * *value);
  if (unit == "\u00b0") return absl::StrFormat("%.1f\u00b0", *value);
  if (std::abs(*value) >= 100) return absl::StrFormat("%.0f %s", *value, unit);
  if (std::abs(*value) >= 10) return absl::StrFormat("%.1f %s", *value, unit);
  return absl::StrFormat("%.3f %s", *value, unit);
}

// Pads by columns, not bytes: a degree sign has two bytes and one column.
std::string Padded(const std::string& text, int columns) {
  const auto seen = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  });
  return absl::StrCat(std::string(static_cast<size_t>(std::max<long>(0, columns - seen)), ' '),
                      text);
}

struct Line {
  std::string title, value;
};

// Prints the figures that compare the two motions.
std::vector<Line> DisplacementLines(const analysis::Comparison& comparison) {
  const Displacement& d = comparison.displacement;
  const auto metres = [](double value) { return absl::StrFormat("%.3f m", value); };
  std::vector<Line> lines = {
      {"joints, on average", metres(d.mean_metres)},
      {"the same with roots put together", metres(d.root_aligned_metres)},
      {"roots, on average", metres(d.root_metres)},
      {"at most",
       absl::StrFormat("%.3f m (%s, frame %d)", d.most_metres, d.most_joint, d.most_frame)},
      {"joint velocities, on average", absl::StrFormat("%.3f m/s", d.velocity_metres_per_second)}};
  if (comparison.partner_metres.has_value()) {
    lines.push_back({"their partners, on average", metres(*comparison.partner_metres)});
  }
  return lines;
}

// Whether at least one of the motions has the figure.
bool IsKnown(const Figure& figure) { return figure.a.has_value() || figure.b.has_value(); }

std::string Cut(const std::string& name) {
  return name.size() <= kNameColumns ? name : absl::StrCat(name.substr(0, kNameColumns - 3), "...");
}

std::string DescribeTake(const char* letter, const Take& take) {
  std::string text = absl::StrFormat("%s         %s: %d frames at %g Hz, %s\n", letter, take.name,
                                     take.leader.frame_count(), take.leader.frame_rate_hz,
                                     take.follower ? "its follower" : "one person");
  for (const std::string& note : take.notes) absl::StrAppend(&text, "          ", note, "\n");
  return text;
}

}  // namespace

std::string DescribeComparison(const ComparedTakes& compared, const Style& style) {
  const analysis::Comparison& comparison = compared.comparison;
  std::string text = absl::StrCat(DescribeTake("A", compared.a), DescribeTake("B", compared.b));
  absl::StrAppendFormat(&text, "compared  %d frames at %g Hz%s\n\n", comparison.frame_count,
                        comparison.frame_rate_hz,
                        comparison.resampled ? ", B resampled to A's rate" : "");
  absl::StrAppend(&text, style.Heading("displacement of B from A"), "\n");
  for (const Line& line : DisplacementLines(comparison)) {
    absl::StrAppendFormat(&text, "  %-44s %s\n", line.title, line.value);
  }
  std::string group;
  for (const Figure& figure : comparison.figures) {
    if (!IsKnown(figure)) continue;
    if (figure.group != group) {
      const bool first = group.empty();
      group = figure.group;
      absl::StrAppend(&text, "\n", style.Heading(absl::StrFormat("%-44s", group)));
      if (first) {
        absl::StrAppend(&text, Padded(Cut(compared.a.name), kNameColumns), " ",
                        Padded(Cut(compared.b.name), kNameColumns));
      }
      text += "\n";
    }
    absl::StrAppendFormat(&text, "  %-42s", figure.title);
    absl::StrAppend(&text, Padded(Shown(figure.a, figure.unit), kNameColumns), " ",
                    Padded(Shown(figure.b, figure.unit), kNameColumns), "\n");
  }
  return text;
}

json ComparisonJson(const ComparedTakes& compared, const motion::Skeleton& skeleton) {
  const analysis::Comparison& comparison = compared.comparison;
  const Displacement& d = comparison.displacement;
  const auto take_json = [](const Take& take) {
    json files = json::array();
    for (const std::filesystem::path& file : take.files) files.push_back(file.string());
    return json{{"name", take.name},
                {"files", files},
                {"frames", take.leader.frame_count()},
                {"frame_rate_hz", take.leader.frame_rate_hz},
                {"people_count", take.follower ? 2 : 1},
                {"notes", take.notes}};
  };
  json joints = json::object();
  for (std::size_t joint = 0; joint < d.joint_metres.size(); ++joint) {
    joints[skeleton.joint_names[joint]] = d.joint_metres[joint];
  }
  json figures = json::object();
  const auto known = [](const std::optional<double>& value) {
    return value ? json(*value) : json();
  };
  for (const Figure& figure : comparison.figures) {
    figures[figure.name] = {{"a", known(figure.a)}, {"b", known(figure.b)}};
  }
  json object = {{"a", take_json(compared.a)},
                 {"b", take_json(compared.b)},
                 {"frames", comparison.frame_count},
                 {"frame_rate_hz", comparison.frame_rate_hz},
                 {"resampled", comparison.resampled},
                 {"displacement",
                  {{"mean_metres", d.mean_metres},
                   {"root_aligned_metres", d.root_aligned_metres},
                   {"root_metres", d.root_metres},
                   {"most_metres", d.most_metres},
                   {"most_joint", d.most_joint},
                   {"most_frame", d.most_frame},
                   {"velocity_metres_per_second", d.velocity_metres_per_second},
                   {"joints", joints}}},
                 {"figures", figures}};
  if (comparison.partner_metres) object["partner_metres"] = *comparison.partner_metres;
  return object;
}

absl::StatusOr<std::string> RenderComparison(const ComparedTakes& compared,
                                             const motion::Skeleton& skeleton) {
  viewer::GalleryContent content;
  for (const Take* take : {&compared.a, &compared.b}) {
    content.motions.push_back({take->name, take->leader, take->follower});
  }
  content.bones = skeleton.bones;
  content.title = absl::StrCat(compared.a.name, " and ", compared.b.name);
  content.subtitle =
      absl::StrFormat("compared over %d frames at %g Hz", compared.comparison.frame_count,
                      compared.comparison.frame_rate_hz);
  content.value_titles = {compared.a.name, compared.b.name};
  const std::string displacement =
      absl::StrCat("displacement of ", compared.b.name, " from ", compared.a.name);
  for (const Line& line : DisplacementLines(compared.comparison)) {
    content.figures.push_back({displacement, line.title, {line.value}});
  }
  for (const Figure& figure : compared.comparison.figures) {
    if (!IsKnown(figure)) continue;
    content.figures.push_back(
        {figure.group, figure.title, {Shown(figure.a, figure.unit), Shown(figure.b, figure.unit)}});
  }
  return RenderGallery(content);
}

}  // namespace duet::client::cli
