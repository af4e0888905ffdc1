#include "model/formats/gltf/gltf_writer.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace duet::formats::gltf {
namespace {

using nlohmann::ordered_json;
using retargeting::Quaternion;
using retargeting::Vec3d;

// Constants of glTF.
constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A,
                   kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied as they are");

void AppendWord(uint32_t word, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&word), sizeof word);
}

void PadTo4(char with, std::string* bytes) {
  while (bytes->size() % 4 != 0) bytes->push_back(with);
}

void AppendChunk(uint32_t type, absl::string_view content, std::string* bytes) {
  AppendWord(static_cast<uint32_t>(content.size()), bytes);
  AppendWord(type, bytes);
  bytes->append(content.data(), content.size());
}

void AppendFloats(std::initializer_list<double> values, std::vector<float>* out) {
  for (double value : values) out->push_back(static_cast<float>(value));
}

std::string Dump(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

GltfWriter::GltfWriter() { json_["asset"] = {{"version", "2.0"}, {"generator", kDuetsWriter}}; }

int GltfWriter::Add(const char* array, ordered_json value) {
  ordered_json& all = json_[array];
  all.push_back(std::move(value));
  return static_cast<int>(all.size()) - 1;
}

void GltfWriter::BeginView(Use use) {
  ordered_json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", 0}};
  if (use == Use::kVertices) view["target"] = kArrayBuffer;
  if (use == Use::kIndices) view["target"] = kElementArrayBuffer;
  Add("bufferViews", std::move(view));
}

int GltfWriter::AddAccessor(int component_type, const char* type, std::size_t count) {
  const ordered_json& view = json_["bufferViews"].back();
  return Add("accessors", {{"bufferView", json_["bufferViews"].size() - 1},
                           {"byteOffset", buffer_.size() - view["byteOffset"].get<std::size_t>()},
                           {"componentType", component_type},
                           {"count", count},
                           {"type", type}});
}

void GltfWriter::EndAccessor() {
  PadTo4('\0', &buffer_);
  ordered_json& view = json_["bufferViews"].back();
  view["byteLength"] = buffer_.size() - view["byteOffset"].get<std::size_t>();
}

int GltfWriter::AddFloats(const char* type, std::size_t components,
                          const std::vector<float>& values) {
  const int accessor = AddAccessor(kFloat, type, values.size() / components);
  buffer_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  EndAccessor();
  return accessor;
}

template <typename Written, typename Value>
int GltfWriter::AddWhole(int component_type, const char* type, std::size_t components,
                         const std::vector<Value>& values) {
  const int accessor = AddAccessor(component_type, type, values.size() / components);
  for (Value value : values) {
    const auto written = static_cast<Written>(value);
    buffer_.append(reinterpret_cast<const char*>(&written), sizeof written);
  }
  EndAccessor();
  return accessor;
}

int GltfWriter::AddTimes(const std::vector<float>& seconds) {
  const int accessor = AddFloats("SCALAR", 1, seconds);
  json_["accessors"].back()["min"] = {seconds.front()};
  json_["accessors"].back()["max"] = {seconds.back()};
  return accessor;
}

int GltfWriter::AddVectors(const std::vector<Vec3d>& vectors) {
  std::vector<float> values;
  for (const Vec3d& v : vectors) AppendFloats({v.x, v.y, v.z}, &values);
  return AddFloats("VEC3", 3, values);
}

int GltfWriter::AddPositions(const std::vector<Vec3d>& positions) {
  const int accessor = AddVectors(positions);
  motion::Vec3 low = ToFloat(positions.front()), high = low;
  for (const Vec3d& position : positions) {
    const motion::Vec3 at = ToFloat(position);
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
  }
  json_["accessors"].back()["min"] = {low.x, low.y, low.z};
  json_["accessors"].back()["max"] = {high.x, high.y, high.z};
  return accessor;
}

int GltfWriter::AddRotations(const std::vector<Quaternion>& rotations) {
  std::vector<float> values;
  for (const Quaternion& q : rotations) AppendFloats({q.x, q.y, q.z, q.w}, &values);
  return AddFloats("VEC4", 4, values);
}

int GltfWriter::AddMatrices(const std::vector<retargeting::Affine>& matrices) {
  std::vector<float> values;
  for (const retargeting::Affine& m : matrices) {
    AppendFloats({m.x.x, m.x.y, m.x.z, 0, m.y.x, m.y.y, m.y.z, 0, m.z.x, m.z.y, m.z.z, 0,
                  m.origin.x, m.origin.y, m.origin.z, 1},
                 &values);
  }
  return AddFloats("MAT4", 16, values);
}

int GltfWriter::AddIndices(const std::vector<uint32_t>& indices, std::size_t vertices) {
  // The largest number of either kind is not an index.
  return vertices <= std::numeric_limits<uint16_t>::max()
             ? AddWhole<uint16_t>(kUnsignedShort, "SCALAR", 1, indices)
             : AddWhole<uint32_t>(kUnsignedInt, "SCALAR", 1, indices);
}

int GltfWriter::AddVertexJoints(const std::vector<int>& joints, std::size_t joint_count) {
  std::vector<int> influences;
  for (int joint : joints) influences.insert(influences.end(), {joint, 0, 0, 0});
  return joint_count <= std::size_t{std::numeric_limits<uint8_t>::max()} + 1
             ? AddWhole<uint8_t>(kUnsignedByte, "VEC4", 4, influences)
             : AddWhole<uint16_t>(kUnsignedShort, "VEC4", 4, influences);
}

int GltfWriter::AddWholeWeights(std::size_t vertices) {
  std::vector<int> weights;
  for (std::size_t i = 0; i < vertices; ++i) weights.insert(weights.end(), {255, 0, 0, 0});
  const int accessor = AddWhole<uint8_t>(kUnsignedByte, "VEC4", 4, weights);
  json_["accessors"].back()["normalized"] = true;
  return accessor;
}

std::string GltfWriter::Binary() {
  json_["buffers"] = {{{"byteLength", buffer_.size()}}};
  std::string text = Dump(json_);
  PadTo4(' ', &text);
  std::string file;
  const std::size_t size = kHeaderBytes + 2 * kChunkHeaderBytes + text.size() + buffer_.size();
  file.reserve(size);
  AppendWord(kMagic, &file);
  AppendWord(kVersion, &file);
  AppendWord(static_cast<uint32_t>(size), &file);
  AppendChunk(kJsonChunk, text, &file);
  AppendChunk(kBinaryChunk, buffer_, &file);
  return file;
}

std::string GltfWriter::Text() {
  json_["buffers"] = {{{"byteLength", buffer_.size()},
                       {"uri", absl::StrCat("data:application/octet-stream;base64,",
                                            absl::Base64Escape(buffer_))}}};
  return Dump(json_) + "\n";
}

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

void AnimationWriter::AddTrack(int node, const char* path, int values) {
  json_["channels"].push_back(
      {{"sampler", json_["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  json_["samplers"].push_back({{"input", times_}, {"interpolation", "LINEAR"}, {"output", values}});
}

}  // namespace duet::formats::gltf
