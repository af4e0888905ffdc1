#include "model/evaluation/report/result_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "model/base/file.h"
#include "model/base/text.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::ordered_json;

ordered_json KindToJson(const LatentPlot& plot) {
  return {{"kind", "latent"},        {"title", plot.title},       {"class_names", plot.class_names},
          {"classes", plot.classes}, {"features", plot.features}, {"perplexity", plot.perplexity},
          {"seed", plot.seed}};
}

const char* SideOf(absl::string_view joint_name) {
  if (absl::StrContains(joint_name, "left")) return "left";
  return absl::StrContains(joint_name, "right") ? "right" : "middle";
}

ordered_json BonesToJson(const motion::Skeleton& skeleton) {
  ordered_json bones = ordered_json::array();
  for (const motion::Bone& bone : skeleton.bones) {
    bones.push_back({{"parent", bone.parent},
                     {"child", bone.child},
                     {"side", SideOf(skeleton.joint_names[static_cast<size_t>(bone.child)])}});
  }
  return bones;
}

// Shape: [frames][joints][3].
ordered_json PosesToJson(const motion::Poses& poses) {
  const auto rounded = [](double metres) { return std::round(metres * 1e4) / 1e4; };
  ordered_json frames = ordered_json::array();
  for (int t = 0; t < poses.frame_count(); ++t) {
    ordered_json joints = ordered_json::array();
    for (const motion::Vec3& p : poses[t]) {
      joints.push_back({rounded(p.x), rounded(p.y), rounded(p.z)});
    }
    frames.push_back(std::move(joints));
  }
  return frames;
}

ordered_json KindToJson(const PosePlot& plot) {
  const int head = plot.skeleton.Find("head");
  ordered_json pairs = ordered_json::array();
  for (const PicturedPair& pair : plot.pairs) {
    pairs.push_back({{"name", pair.name},
                     {"leader", PosesToJson(pair.leader)},
                     {"follower", PosesToJson(pair.follower)}});
  }
  return {{"kind", "poses"},
          {"title", plot.title},
          {"frame_rate_hz", plot.frame_rate_hz},
          {"root", plot.skeleton.root},
          {"head", head < 0 ? ordered_json(nullptr) : ordered_json(head)},
          {"bones", BonesToJson(plot.skeleton)},
          {"pairs", std::move(pairs)}};
}

constexpr int kFormatVersion = 1;
constexpr size_t kMaxNameBytes = 64;
constexpr const char* kBestNames[] = {"none", "lowest", "highest"};  // as in Best

absl::Status CheckName(const std::string& field, const std::string& name) {
  const bool is_name = !name.empty() && name.size() <= kMaxNameBytes &&
                       std::all_of(name.begin(), name.end(), [](unsigned char c) {
                         return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '_';
                       });
  if (is_name) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(field, ": expected 1 to 64 of a-z, 0-9 and _, got ", base::Quoted(name)));
}

absl::Status CheckTable(const std::string& field, const Table& table) {
  for (size_t r = 0; r < table.rows.size(); ++r) {
    const std::vector<double>& values = table.rows[r].values;
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isinf(v); })) {
      return absl::InvalidArgumentError(absl::StrCat(
          field, ".rows[", r, "].values: expected finite numbers or NaN, got an infinite one"));
    }
  }
  return absl::OkStatus();
}

absl::Status Check(const ResultSection& section) {
  absl::Status status = CheckName("id", section.id);
  for (size_t i = 0; i < section.tables.size(); ++i) {
    status.Update(CheckTable(absl::StrCat("tables[", i, "]"), section.tables[i]));
  }
  std::set<std::string> seen;
  for (size_t i = 0; i < section.figures.size(); ++i) {
    const std::string field = absl::StrCat("figures[", i, "].name");
    const std::string& name = section.figures[i].name;
    status.Update(CheckName(field, name));
    if (!seen.insert(name).second) {
      status.Update(absl::InvalidArgumentError(
          absl::StrCat(field, ": expected a new name, got ", base::Quoted(name), " again")));
    }
  }
  return status;
}

// NaN becomes null.
ordered_json TableToJson(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const TableRow& row : table.rows) {
    rows.push_back({{"name", row.name}, {"printed", row.printed}, {"values", row.values}});
  }
  return {{"title", table.title},       {"columns", table.columns},
          {"rows", std::move(rows)},    {"notes", table.notes},
          {"decimals", table.decimals}, {"best", kBestNames[static_cast<size_t>(table.best)]}};
}

std::string SectionToJson(const ResultSection& section) {
  ordered_json tables = ordered_json::array();
  for (const Table& table : section.tables) tables.push_back(TableToJson(table));
  ordered_json figures = ordered_json::array();
  for (const ResultFigure& figure : section.figures) {
    figures.push_back(
        {{"name", figure.name}, {"caption", figure.caption}, {"plot", ToJson(figure.plot)}});
  }
  ordered_json settings = ordered_json::array();
  for (const auto& [name, value] : section.settings) {
    settings.push_back({{"name", name}, {"value", value}});
  }
  const ordered_json whole = {{"format_version", kFormatVersion},
                              {"id", section.id},
                              {"title", section.title},
                              {"text", section.text},
                              {"tables", std::move(tables)},
                              {"figures", std::move(figures)},
                              {"settings", std::move(settings)},
                              {"command", section.command},
                              {"date", section.date}};
  return whole.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace

ordered_json ToJson(const Plot& plot) {
  return std::visit([](const auto& one) { return KindToJson(one); }, plot);
}

absl::Status WriteSection(const ResultSection& section, const std::filesystem::path& folder) {
  if (absl::Status status = Check(section); !status.ok()) return status;
  std::error_code error;  // base::WriteFile reports a folder that cannot be made
  std::filesystem::create_directories(folder, error);
  return base::WriteFile(folder / (section.id + ".json"), SectionToJson(section));
}

std::string Today() { return absl::FormatTime("%Y-%m-%d", absl::Now(), absl::UTCTimeZone()); }

}  // namespace duet::evaluation::report
