#include "contrib/formats/fbx/skin_writing.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "assimp/material.h"
#include "model/base/index.h"
#include "nlohmann/json.hpp"

namespace duet::contrib::formats::fbx {
namespace {

using gltf::GltfWriter;
using nlohmann::ordered_json;
using retargeting::Affine;
using retargeting::Vec3d;

constexpr unsigned kMostVertices = 4'000'000;
constexpr std::size_t kInfluences = 4;

using base::Index;

std::vector<Vec3d> ToVectors(const aiVector3D* vectors, unsigned count) {
  std::vector<Vec3d> converted;
  for (unsigned i = 0; i < count; ++i) {
    converted.push_back({static_cast<double>(vectors[i].x), static_cast<double>(vectors[i].y),
                         static_cast<double>(vectors[i].z)});
  }
  return converted;
}

// The joints of a skin and their bind matrices.
struct Joints {
  std::vector<int> nodes;
  std::vector<Affine> to_joint;

  int PlaceOf(int node) const {
    const auto found = std::find(nodes.begin(), nodes.end(), node);
    return found == nodes.end() ? -1 : static_cast<int>(found - nodes.begin());
  }
};

Joints JointsOf(const aiMesh& mesh, const NodeTree& tree, const std::set<int>& animated) {
  Joints joints;
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const int node = tree.Find(mesh.mBones[b]->mName.C_Str());
    if (node < 0 || joints.PlaceOf(node) >= 0) continue;
    const auto bound = tree.to_joint.find(mesh.mBones[b]);
    joints.nodes.push_back(node);
    joints.to_joint.push_back(bound == tree.to_joint.end() ? Affine{} : bound->second);
  }
  if (joints.nodes.empty()) return joints;
  int highest = -1;
  for (int node = joints.nodes[0]; node >= 0; node = tree.nodes[Index(node)].parent) {
    if (animated.count(node) > 0) highest = node;
  }
  if (highest >= 0 && joints.PlaceOf(highest) < 0) {
    joints.nodes.push_back(highest);
    joints.to_joint.push_back({});  // of no vertex
  }
  return joints;
}

int AddSkin(const std::string& name, const Joints& joints, GltfWriter* writer) {
  writer->BeginView(GltfWriter::Use::kOther);
  const int matrices = writer->AddMatrices(joints.to_joint);
  return writer->Add("skins",
                     {{"name", name}, {"inverseBindMatrices", matrices}, {"joints", joints.nodes}});
}

int AddMaterial(const aiMaterial& material, GltfWriter* writer) {
  aiColor4D colour(0.8f, 0.8f, 0.8f, 1);
  aiGetMaterialColor(&material, AI_MATKEY_COLOR_DIFFUSE, &colour);
  const auto share = [](float value) { return std::min(std::max(value, 0.0f), 1.0f); };
  return writer->Add("materials",
                     {{"pbrMetallicRoughness",
                       {{"baseColorFactor", {share(colour.r), share(colour.g), share(colour.b), 1}},
                        {"metallicFactor", 0},
                        {"roughnessFactor", 0.8}}},
                      {"doubleSided", true}});
}

// The joints of each vertex and their weights, which sum to 1.
void AddInfluences(const aiMesh& mesh, const NodeTree& tree, const Joints& joints,
                   ordered_json* attributes, GltfWriter* writer) {
  std::vector<std::array<int, kInfluences>> places(mesh.mNumVertices);
  std::vector<std::array<float, kInfluences>> weights(mesh.mNumVertices);
  std::vector<std::size_t> used(mesh.mNumVertices);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const int place = joints.PlaceOf(tree.Find(bone.mName.C_Str()));
    for (unsigned w = 0; place >= 0 && w < bone.mNumWeights; ++w) {
      const unsigned vertex = bone.mWeights[w].mVertexId;
      if (vertex >= mesh.mNumVertices || used[vertex] == kInfluences) continue;
      if (!(bone.mWeights[w].mWeight > 0)) continue;
      places[vertex][used[vertex]] = place;
      weights[vertex][used[vertex]++] = bone.mWeights[w].mWeight;
    }
  }
  for (std::array<float, kInfluences>& of_vertex : weights) {
    float sum = 0;
    for (float weight : of_vertex) sum += weight;
    if (!(sum > 0)) of_vertex[0] = sum = 1;
    for (float& weight : of_vertex) weight /= sum;
  }
  writer->BeginView(GltfWriter::Use::kVertices);
  (*attributes)["JOINTS_0"] = writer->AddVertexJoints(places);
  writer->BeginView(GltfWriter::Use::kVertices);
  (*attributes)["WEIGHTS_0"] = writer->AddVertexWeights(weights);
}

std::vector<uint32_t> TrianglesOf(const aiMesh& mesh) {
  std::vector<uint32_t> indices;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    const bool valid = std::all_of(face.mIndices, face.mIndices + 3,
                                   [&mesh](unsigned vertex) { return vertex < mesh.mNumVertices; });
    if (valid) indices.insert(indices.end(), face.mIndices, face.mIndices + 3);
  }
  return indices;
}

void AddMesh(const aiMesh& mesh, const NodeTree& tree, const Joints& joints, int skin, int material,
             GltfWriter* writer) {
  const std::vector<uint32_t> indices = TrianglesOf(mesh);
  if (indices.empty()) return;
  ordered_json attributes;
  writer->BeginView(GltfWriter::Use::kVertices);
  attributes["POSITION"] = writer->AddPositions(ToVectors(mesh.mVertices, mesh.mNumVertices));
  if (mesh.HasNormals()) {
    writer->BeginView(GltfWriter::Use::kVertices);
    std::vector<Vec3d> normals = ToVectors(mesh.mNormals, mesh.mNumVertices);
    for (Vec3d& normal : normals) normal = Unit(normal, {0, 1, 0});
    attributes["NORMAL"] = writer->AddVectors(normals);
  }
  AddInfluences(mesh, tree, joints, &attributes, writer);
  writer->BeginView(GltfWriter::Use::kIndices);
  ordered_json primitive = {{"attributes", std::move(attributes)},
                            {"indices", writer->AddIndices(indices, mesh.mNumVertices)}};
  if (material >= 0) primitive["material"] = material;
  const std::string name = mesh.mName.C_Str();
  const int index = writer->Add(
      "meshes", {{"name", name}, {"primitives", ordered_json::array({std::move(primitive)})}});
  const int node = writer->Add("nodes", {{"name", name}, {"mesh", index}, {"skin", skin}});
  writer->json()["scenes"][0]["nodes"].push_back(node);
}

}  // namespace

absl::Status WriteSkins(const aiScene& scene, const NodeTree& tree, const std::set<int>& animated,
                        GltfWriter* writer) {
  std::size_t vertices = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const Joints joints = JointsOf(mesh, tree, animated);
    if (joints.nodes.empty()) continue;
    const int skin = AddSkin(mesh.mName.C_Str(), joints, writer);
    vertices += mesh.mNumVertices;
    if (mesh.mNumVertices == 0) continue;
    if (vertices > kMostVertices) {
      return absl::InvalidArgumentError(
          absl::StrCat("meshes: expected at most ", kMostVertices, " vertices, got more"));
    }
    const int material = mesh.mMaterialIndex < scene.mNumMaterials
                             ? AddMaterial(*scene.mMaterials[mesh.mMaterialIndex], writer)
                             : -1;
    AddMesh(mesh, tree, joints, skin, material, writer);
  }
  return absl::OkStatus();
}

}  // namespace duet::contrib::formats::fbx
