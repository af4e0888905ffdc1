#include "model/formats/gltf/gltf_parts.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::formats::gltf {

using nlohmann::ordered_json;
using retargeting::Linear;
using retargeting::Quaternion;
using retargeting::Vec3d;

AnimationWriter::AnimationWriter(const std::string& name, std::size_t frames, double frame_rate_hz,
                                 GltfWriter* writer)
    : writer_(*writer),
      json_({{"name", name},
             {"channels", ordered_json::array()},
             {"samplers", ordered_json::array()}}) {
  std::vector<float> seconds;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    seconds.push_back(static_cast<float>(static_cast<double>(frame) / frame_rate_hz));
  }
  writer_.BeginView(GltfWriter::Use::kOther);
  times_ = writer_.AddTimes(seconds);
}

void AnimationWriter::Translate(int node, const std::vector<Vec3d>& translations) {
  AddTrack(node, "translation", writer_.AddVectors(translations));
}

void AnimationWriter::Rotate(int node, const std::vector<Quaternion>& rotations) {
  AddTrack(node, "rotation", writer_.AddRotations(rotations));
}

void AnimationWriter::Scale(int node, const std::vector<Vec3d>& scales) {
  AddTrack(node, "scale", writer_.AddVectors(scales));
}

void AnimationWriter::AddTrack(int node, const char* path, int values) {
  json_["channels"].push_back(
      {{"sampler", json_["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  json_["samplers"].push_back({{"input", times_}, {"interpolation", "LINEAR"}, {"output", values}});
}

ordered_json ToArray(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

// No joint is rotated at rest, so a bind matrix is a translation.
int AddSkin(const std::string& name, int first_joint, const std::vector<Vec3d>& rest_positions,
            GltfWriter* writer) {
  std::vector<retargeting::Affine> to_joints;
  ordered_json joints = ordered_json::array();
  for (const Vec3d& position : rest_positions) {
    joints.push_back(first_joint + static_cast<int>(to_joints.size()));
    to_joints.emplace_back().origin = -position;
  }
  writer->BeginView(GltfWriter::Use::kOther);
  const int matrices = writer->AddMatrices(to_joints);
  return writer->Add("skins", {{"name", name},
                               {"inverseBindMatrices", matrices},
                               {"skeleton", first_joint},
                               {"joints", std::move(joints)}});
}

int AddMaterial(const std::string& name, const retargeting::Look& look, GltfWriter* writer) {
  const retargeting::Colour colour = look.colour;
  return writer->Add(
      "materials",
      {{"name", name},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {Linear(colour.red), Linear(colour.green), Linear(colour.blue), 1}},
         {"metallicFactor", 0},
         {"roughnessFactor", look.roughness}}}});
}

ordered_json AddPrimitive(const retargeting::SkinnedMesh& mesh, std::size_t joint_count,
                          int material, GltfWriter* writer) {
  const auto vertices = [writer](auto add) {
    writer->BeginView(GltfWriter::Use::kVertices);
    return add();
  };
  ordered_json attributes;
  attributes["POSITION"] = vertices([&] { return writer->AddPositions(mesh.positions); });
  attributes["NORMAL"] = vertices([&] { return writer->AddVectors(mesh.normals); });
  attributes["JOINTS_0"] =
      vertices([&] { return writer->AddVertexJoints(mesh.joints, joint_count); });
  attributes["WEIGHTS_0"] = vertices([&] { return writer->AddWholeWeights(mesh.joints.size()); });
  writer->BeginView(GltfWriter::Use::kIndices);
  const int indices = writer->AddIndices(mesh.indices, mesh.positions.size());
  return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", material}};
}

ordered_json Extras(const motion::Provenance& provenance) {
  ordered_json labels = ordered_json::array();
  for (const motion::Provenance::Labels& key : provenance.labels) {
    ordered_json weights = ordered_json::object();
    for (const auto& [interaction_class, weight] : key.weights) weights[interaction_class] = weight;
    labels.push_back({{"frame", key.frame}, {"weights", std::move(weights)}});
  }
  ordered_json extras = {{"model", absl::StrCat(provenance.model, "@", provenance.model_version)},
                         {"labels", std::move(labels)},
                         {"seed", provenance.seed},
                         {"variety", provenance.variety}};
  if (provenance.candidates != 1) extras["candidates"] = provenance.candidates;
  extras["cleaned_up"] = provenance.cleaned_up;
  return extras;
}

}  // namespace duet::formats::gltf
