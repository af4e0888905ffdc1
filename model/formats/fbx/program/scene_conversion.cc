#include "model/formats/fbx/program/scene_conversion.h"

#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/formats/fbx/program/node_tree.h"
#include "model/formats/fbx/program/skin_writing.h"
#include "model/formats/fbx/program/take_sampling.h"
#include "model/formats/gltf/gltf_parts.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/motion_limits.h"
#include "nlohmann/json.hpp"

namespace duet::formats::fbx::program {
namespace {

using gltf::GltfWriter;
using nlohmann::ordered_json;
using retargeting::Parts;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr unsigned kMostTakes = 1000;
constexpr double kUnstatedRateHz = 30;
// The rates of FbxTime's modes; 0: another rate, which the file states.
constexpr double kModeRates[] = {
    0, 120, 100, 60, 50, 48, 30, 30, 30000.0 / 1001, 30000.0 / 1001, 25, 24, 1000, 24000.0 / 1001};

int Integer(const aiScene& scene, const char* key) {
  int value = -1;
  return scene.mMetaData != nullptr && scene.mMetaData->Get(key, value) ? value : -1;
}

double Number(const aiScene& scene, const char* key) {
  if (scene.mMetaData == nullptr) return 0;
  float single = 0;
  double value = 0;
  if (!scene.mMetaData->Get(key, value) && scene.mMetaData->Get(key, single)) {
    value = static_cast<double>(single);
  }
  return std::isfinite(value) && value > 0 ? value : 0;
}

// 0 if the file states none that motions can have.
double StatedRate(const aiScene& scene) {
  const int mode = Integer(scene, "FrameRate");
  const bool known = mode >= 0 && mode < static_cast<int>(std::size(kModeRates));
  double rate = known ? kModeRates[mode] : 0;
  if (rate == 0) rate = Number(scene, "CustomFrameRate");
  return motion::CheckFrameRate("rate", rate).ok() ? rate : 0;
}

// The name of an axis in the line of statements; "" for one that Duet does not have.
std::string UpAxis(const aiScene& scene) {
  const int axis = Integer(scene, "UpAxis"), sign = Integer(scene, "UpAxisSign");
  if (axis == 1) return sign < 0 ? "y-down" : "y-up";
  return axis == 2 && sign > 0 ? "z-up" : "";
}

ordered_json ToJson(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

ordered_json ToJson(Quaternion q) {
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
          static_cast<float>(q.w)};
}

void WriteNodes(const NodeTree& tree, GltfWriter* writer) {
  std::vector<ordered_json> children(tree.nodes.size(), ordered_json::array());
  ordered_json roots = ordered_json::array();
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const int parent = tree.nodes[n].parent;
    (parent < 0 ? roots : children[static_cast<std::size_t>(parent)]).push_back(n);
  }
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const Parts parts = ToParts(tree.rest[n]);
    ordered_json node = {{"name", tree.nodes[n].name},
                         {"translation", ToJson(parts.translation)},
                         {"rotation", ToJson(parts.rotation)},
                         {"scale", ToJson(parts.scale)}};
    if (!children[n].empty()) node["children"] = std::move(children[n]);
    writer->Add("nodes", std::move(node));
  }
  writer->Add("scenes", {{"nodes", std::move(roots)}});
  writer->json()["scene"] = 0;
}

void AddTrack(const Track& track, gltf::AnimationWriter* animation) {
  std::vector<Vec3d> translations, scales;
  std::vector<Quaternion> rotations;
  bool scaled = false;
  for (const Parts& parts : track.frames) {
    translations.push_back(parts.translation);
    rotations.push_back(parts.rotation);
    scales.push_back(parts.scale);
    scaled = scaled || Norm(parts.scale - Vec3d{1, 1, 1}) > 1e-6;
  }
  animation->Translate(track.node, translations);
  animation->Rotate(track.node, rotations);
  if (scaled) animation->Scale(track.node, scales);
}

// Adds the takes that move a node; `animated` receives these nodes.
absl::Status WriteTakes(const aiScene& scene, const NodeTree& tree, double frame_rate_hz,
                        std::set<int>* animated, GltfWriter* writer) {
  if (scene.mNumAnimations > kMostTakes) {
    return absl::InvalidArgumentError(
        absl::StrCat("animations: expected at most ", kMostTakes, ", got ", scene.mNumAnimations));
  }
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& take = *scene.mAnimations[a];
    const absl::StatusOr<std::vector<Track>> tracks = SampleTake(take, tree, frame_rate_hz);
    if (!tracks.ok()) return tracks.status();
    if (tracks->empty()) continue;
    gltf::AnimationWriter animation(take.mName.C_Str(), tracks->front().frames.size(),
                                    frame_rate_hz, writer);
    for (const Track& track : *tracks) {
      AddTrack(track, &animation);
      animated->insert(track.node);
    }
    writer->Add("animations", animation.Take());
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::string> ConvertScene(const aiScene& scene, const ConversionOptions& options) {
  const absl::StatusOr<NodeTree> tree = MakeNodeTree(scene, options.to_world);
  if (!tree.ok()) return tree.status();
  const double stated_rate = StatedRate(scene);
  GltfWriter writer;
  writer.json()["asset"]["generator"] = "duet-fbx";
  WriteNodes(*tree, &writer);
  std::set<int> animated;
  absl::Status status =
      WriteTakes(scene, *tree, stated_rate > 0 ? stated_rate : kUnstatedRateHz, &animated, &writer);
  if (status.ok()) status = WriteSkins(scene, *tree, animated, options.with_meshes, &writer);
  if (!status.ok()) return status;
  const ordered_json statements = {{"unit_scale_factor", Number(scene, "UnitScaleFactor")},
                                   {"up_axis", UpAxis(scene)},
                                   {"frame_rate_hz", stated_rate}};
  return absl::StrCat(statements.dump(), "\n", writer.Binary());
}

}  // namespace duet::formats::fbx::program
