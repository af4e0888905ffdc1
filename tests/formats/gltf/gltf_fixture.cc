#include "tests/formats/gltf/gltf_fixture.h"

#include <cstdint>
#include <cstring>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rig_fitting.h"

namespace duet::test {
namespace {

using Json = nlohmann::json;

void AppendUint32(std::size_t value, std::string* out) {
  for (int shift = 0; shift < 32; shift += 8) out->push_back(static_cast<char>(value >> shift));
}

// A key for each frame; splines with tangents of zero.
std::vector<float> Keys(const std::vector<float>& values, std::size_t components, bool spline) {
  if (!spline) return values;
  std::vector<float> keys;
  const std::vector<float> level(components);
  for (std::size_t i = 0; i < values.size(); i += components) {
    keys.insert(keys.end(), level.begin(), level.end());
    const auto key = values.begin() + static_cast<std::ptrdiff_t>(i);
    keys.insert(keys.end(), key, key + static_cast<std::ptrdiff_t>(components));
    keys.insert(keys.end(), level.begin(), level.end());
  }
  return keys;
}

}  // namespace

GltfBuilder::GltfBuilder() { json_["asset"] = {{"version", "2.0"}}; }

int GltfBuilder::AddAccessor(const std::vector<float>& values, const std::string& type) {
  const std::size_t components = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
  const std::size_t bytes = values.size() * sizeof(float);
  json_["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}});
  json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                {"componentType", 5126},
                                {"count", values.size() / components},
                                {"type", type}});
  buffer_.append(reinterpret_cast<const char*>(values.data()), bytes);
  json_["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
  return static_cast<int>(json_["accessors"].size()) - 1;
}

int GltfBuilder::AddNode(Json node) {
  json_["nodes"].push_back(std::move(node));
  return static_cast<int>(json_["nodes"].size()) - 1;
}

std::string GltfBuilder::WithDataUri() const {
  return WithFile("data:application/octet-stream;base64," + absl::Base64Escape(buffer_));
}

std::string GltfBuilder::WithFile(const std::string& uri) const {
  Json with_uri = json_;
  with_uri["buffers"][0]["uri"] = uri;
  return with_uri.dump();
}

std::string GltfBuilder::Binary() const { return BinaryGltf(json_.dump(), buffer_); }

std::string BinaryGltf(const std::string& json, const std::string& binary) {
  std::string padded_json = json, padded_binary = binary;
  while (padded_json.size() % 4 != 0) padded_json += ' ';
  while (padded_binary.size() % 4 != 0) padded_binary += '\0';
  std::string out = "glTF";
  AppendUint32(2, &out);
  AppendUint32(12 + 8 + padded_json.size() + 8 + padded_binary.size(), &out);
  AppendUint32(padded_json.size(), &out);
  out += "JSON" + padded_json;
  AppendUint32(padded_binary.size(), &out);
  out += std::string("BIN\0", 4) + padded_binary;
  return out;
}

void AddPerson(const motion::Clip& clip, const GltfPersonOptions& options, GltfBuilder* builder) {
  const retargeting::Rig rig = retargeting::MakeRig(motion::SbuSkeleton(), clip);
  const double unit = options.centimetres_below_an_armature ? 100 : 1;
  std::vector<int> nodes;
  for (const retargeting::RigJoint& joint : rig.joints) {
    const retargeting::Vec3d offset = joint.offset * unit;
    nodes.push_back(builder->AddNode({{"name", options.name_prefix + joint.name},
                                      {"translation", {offset.x, offset.y, offset.z}}}));
    if (joint.parent < 0) continue;
    const int parent = nodes[static_cast<size_t>(joint.parent)];
    builder->json()["nodes"][static_cast<size_t>(parent)]["children"].push_back(nodes.back());
  }
  if (options.centimetres_below_an_armature) {
    // Bones with z up, turned by the armature; a quarter turn about x.
    const double half = std::sqrt(0.5);
    builder->AddNode({{"name", "Armature"},
                      {"children", {nodes[0]}},
                      {"scale", {0.01, 0.01, 0.01}},
                      {"rotation", {-half, 0, 0, half}}});
  }
  if (options.with_skin) builder->json()["skins"].push_back({{"joints", nodes}});

  std::vector<float> times, places;
  std::vector<std::vector<float>> turns(nodes.size());
  retargeting::PoseFitter fitter(rig, clip.frame_rate_hz);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    times.push_back(static_cast<float>(2 + frame / clip.frame_rate_hz));
    retargeting::RigPose pose = fitter.Fit(clip.poses[frame]);
    if (options.centimetres_below_an_armature) {
      const retargeting::Quaternion back = retargeting::AxisAngle({1, 0, 0}, 1.5707963267948966);
      pose.root_position = Rotate(back, pose.root_position) * unit;
      pose.rotations[0] = back * pose.rotations[0];
    }
    for (double v : {pose.root_position.x, pose.root_position.y, pose.root_position.z}) {
      places.push_back(static_cast<float>(v));
    }
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const retargeting::Quaternion& q = pose.rotations[j];
      for (double v : {q.x, q.y, q.z, q.w}) turns[j].push_back(static_cast<float>(v));
    }
  }
  const bool spline = options.interpolation == "CUBICSPLINE";
  const int time_accessor = builder->AddAccessor(times, "SCALAR");
  Json animation = {{"name", options.animation}};
  const auto add_channel = [&](int node, const char* path, int accessor) {
    animation["samplers"].push_back(
        {{"input", time_accessor}, {"output", accessor}, {"interpolation", options.interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  };
  add_channel(nodes[0], "translation", builder->AddAccessor(Keys(places, 3, spline), "VEC3"));
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    add_channel(nodes[j], "rotation", builder->AddAccessor(Keys(turns[j], 4, spline), "VEC4"));
  }
  builder->json()["animations"].push_back(animation);
}

}  // namespace duet::test
