#include "model/evaluation/report/plot.h"

#include <cmath>
#include <cstddef>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::ordered_json;

ordered_json KindToJson(const LinePlot& plot) {
  ordered_json series = ordered_json::array();
  for (const PlotSeries& one : plot.series) {
    ordered_json x = ordered_json::array(), y = ordered_json::array();
    for (const auto& point : one.points) {
      x.push_back(point[0]);
      y.push_back(point[1]);
    }
    series.push_back({{"name", one.name}, {"x", std::move(x)}, {"y", std::move(y)}});
  }
  ordered_json y_range = nullptr;
  if (plot.y_range) y_range = {plot.y_range->first, plot.y_range->second};
  return {{"kind", "lines"},
          {"title", plot.title},
          {"x_label", plot.x_label},
          {"y_label", plot.y_label},
          {"series", std::move(series)},
          {"y_range", std::move(y_range)},
          {"log_y", plot.log_y},
          {"markers", plot.markers},
          {"marked_x", plot.marked_x},
          {"running_mean", plot.running_mean}};
}

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

}  // namespace

ordered_json ToJson(const Plot& plot) {
  return std::visit([](const auto& one) { return KindToJson(one); }, plot);
}

}  // namespace duet::evaluation::report
