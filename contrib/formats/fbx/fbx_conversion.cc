#include "contrib/formats/fbx/fbx_conversion.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "assimp/BaseImporter.h"
#include "assimp/Importer.hpp"
#include "assimp/config.h"
#include "assimp/importerdesc.h"
#include "assimp/postprocess.h"
#include "assimp/scene.h"
#include "contrib/formats/fbx/node_tree.h"
#include "contrib/formats/fbx/skin_writing.h"
#include "contrib/formats/fbx/take_sampling.h"
#include "model/base/printable.h"
#include "model/formats/gltf/gltf_parts.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/coordinates.h"
#include "model/motion/motion_limits.h"
#include "model/retargeting/affine.h"
#include "model/retargeting/character_rig.h"
#include "nlohmann/json.hpp"

namespace duet::contrib::formats::fbx {
namespace {

using gltf::GltfWriter;
using nlohmann::ordered_json;
using retargeting::Parts;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr unsigned kMostTakes = 1000;
constexpr double kUnstatedRateHz = 30;
constexpr double kCentimetre = 0.01;  // metres
// Metres from a hand to a foot: a small child's and a giant's. An adult in centimetres that are
// stated as inches has 6 m.
constexpr double kSmallestPerson = 1, kLargestPerson = 4;
constexpr std::size_t kLongestMessage = 200;
// Binary FBX begins with "Kaydara FBX Binary", FBX as text with a comment or FBXHeaderExtension.
constexpr std::size_t kHeaderBytes = 4096;
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

motion::UpAxis UpAxisOf(const aiScene& scene) {
  const int axis = Integer(scene, "UpAxis"), sign = Integer(scene, "UpAxisSign");
  if (axis == 1 && sign < 0) return motion::UpAxis::kYDown;
  return axis == 2 && sign > 0 ? motion::UpAxis::kZUp : motion::UpAxis::kYUp;
}

// From the scene's axes to y up, and from its unit to metres.
retargeting::Affine ToWorld(const aiScene& scene, double metres) {
  return retargeting::FromParts(
      {{}, retargeting::ToWorldAxes(UpAxisOf(scene)), {metres, metres, metres}});
}

// The longest way along the bones from one joint to another, such as from a hand to a foot, which
// no pose changes; 0 without bones.
double SizeOf(const aiScene& scene, const NodeTree& tree) {
  std::set<int> joints;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      joints.insert(tree.Find(mesh.mBones[b]->mName.C_Str()));
    }
  }
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& take = *scene.mAnimations[a];
    for (unsigned c = 0; c < take.mNumChannels; ++c) {
      joints.insert(tree.Find(take.mChannels[c]->mNodeName.C_Str()));
    }
  }
  joints.erase(-1);
  const std::vector<retargeting::Affine> world = WorldOf(tree);
  const auto at = [&world](int joint) { return world[static_cast<std::size_t>(joint)].origin; };
  std::map<int, double> reach;  // the longest way down from a joint
  double size = 0;
  for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint) {  // parents last
    int above = *joint;
    do {
      above = tree.nodes[static_cast<std::size_t>(above)].parent;
    } while (above >= 0 && joints.count(above) == 0);
    if (above < 0) continue;
    const double way = reach[*joint] + Norm(at(*joint) - at(above));
    size = std::max(size, reach[above] + way);
    reach[above] = std::max(reach[above], way);
  }
  return size;
}

// The nodes in metres, y up. Many programs state a unit that is not the file's. If nobody is of
// such a size, the numbers stay as they are, and the reader of the glTF infers their unit. A unit
// that the file does not state is FBX's own, a centimetre.
absl::StatusOr<NodeTree> MakeTree(const aiScene& scene) {
  const double centimetres = Number(scene, "UnitScaleFactor");
  const double metres = kCentimetre * (centimetres > 0 ? centimetres : 1);
  absl::StatusOr<NodeTree> tree = MakeNodeTree(scene, ToWorld(scene, metres));
  if (!tree.ok()) return tree;
  const double size = SizeOf(scene, *tree);
  if (size == 0 || (size >= kSmallestPerson && size <= kLargestPerson)) return tree;
  return MakeNodeTree(scene, ToWorld(scene, 1));
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

// Leaves assimp only its reader of FBX, whatever the bytes are.
void KeepOnlyFbx(Assimp::Importer* importer) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer->GetImporterCount(); ++i) {
    const std::string extensions = importer->GetImporterInfo(i)->mFileExtensions;
    if (extensions != "fbx") others.push_back(importer->GetImporter(i));
  }
  for (Assimp::BaseImporter* other : others) {
    importer->UnregisterLoader(other);
    delete other;
  }
}

absl::StatusOr<std::string> ConvertScene(const aiScene& scene) {
  const absl::StatusOr<NodeTree> tree = MakeTree(scene);
  if (!tree.ok()) return tree.status();
  const double stated_rate = StatedRate(scene);
  GltfWriter writer;
  writer.json()["asset"]["generator"] = "duet-fbx";
  WriteNodes(*tree, &writer);
  std::set<int> animated;
  absl::Status status =
      WriteTakes(scene, *tree, stated_rate > 0 ? stated_rate : kUnstatedRateHz, &animated, &writer);
  if (status.ok()) status = WriteSkins(scene, *tree, animated, &writer);
  if (!status.ok()) return status;
  return writer.Binary();
}

}  // namespace

absl::StatusOr<std::string> ConvertFbx(const std::string& content) {
  if (!absl::StrContains(absl::string_view(content).substr(0, kHeaderBytes), "FBX")) {
    return absl::InvalidArgumentError("expected FBX, binary or text, got another kind of file");
  }
  Assimp::Importer importer;
  KeepOnlyFbx(&importer);
  // Without its own nodes, assimp drops pivots from animations.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
  const aiScene* const scene = importer.ReadFileFromMemory(
      content.data(), content.size(), aiProcess_Triangulate | aiProcess_LimitBoneWeights, "fbx");
  if (scene != nullptr && scene->mRootNode != nullptr) return ConvertScene(*scene);
  return absl::InvalidArgumentError(
      absl::StrCat("expected FBX 7.1 or later, binary or text, got a file that assimp rejects: ",
                   base::Printable(importer.GetErrorString(), kLongestMessage)));
}

}  // namespace duet::contrib::formats::fbx
