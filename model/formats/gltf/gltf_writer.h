#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_WRITER_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_WRITER_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"
#include "nlohmann/json.hpp"

namespace duet::formats::gltf {

// GltfDocument::writer of files that Duet writes.
inline constexpr char kDuetsWriter[] = "Duet";

// Builds a glTF document: its JSON and one buffer.
class GltfWriter {
 public:
  GltfWriter();
  // Extends a document with one buffer.
  GltfWriter(nlohmann::ordered_json json, std::string buffer)
      : json_(std::move(json)), buffer_(std::move(buffer)) {}

  // The document, with the format's names.
  nlohmann::ordered_json& json() { return json_; }
  // Adds to an array of the document ("nodes") and returns the index.
  int Add(const char* array, nlohmann::ordered_json value);

  // The use of a view's bytes. The format distinguishes only those of meshes.
  enum class Use { kOther, kVertices, kIndices };
  // Starts a view. Accessors that are added afterwards belong to it.
  void BeginView(Use use);

  // Appends the values to the buffer. Returns the accessor.
  int AddTimes(const std::vector<float>& seconds);  // with their range
  int AddVectors(const std::vector<retargeting::Vec3d>& vectors);
  int AddPositions(const std::vector<retargeting::Vec3d>& positions);  // with their range
  int AddRotations(const std::vector<retargeting::Quaternion>& rotations);
  int AddMatrices(const std::vector<retargeting::Affine>& matrices);
  int AddIndices(const std::vector<uint32_t>& indices, std::size_t vertices);
  // Assigns one joint to each vertex, with weight 1.
  int AddVertexJoints(const std::vector<int>& joints, std::size_t joint_count);
  int AddWholeWeights(std::size_t vertices);

  // Formats the file: binary, or text that embeds the buffer.
  std::string Binary();
  std::string Text();

 private:
  // Adds an accessor for the values appended next.
  int AddAccessor(int component_type, const char* type, std::size_t count);
  // Pads the buffer to a multiple of four bytes and extends the view.
  void EndAccessor();
  // Adds all values of an accessor of this type, in the order of the file.
  int AddFloats(const char* type, std::size_t components, const std::vector<float>& values);
  template <typename Written, typename Value>
  int AddWhole(int component_type, const char* type, std::size_t components,
               const std::vector<Value>& values);

  nlohmann::ordered_json json_;
  std::string buffer_;
};

// One animation of a document, with keys at every frame.
class AnimationWriter {
 public:
  // `writer` must outlive this object.
  AnimationWriter(const std::string& name, std::size_t frames, double frame_rate_hz,
                  GltfWriter* writer);

  // Shapes: [frames], in the axes of the node's parent.
  void Translate(int node, const std::vector<retargeting::Vec3d>& translations);
  void Rotate(int node, const std::vector<retargeting::Quaternion>& rotations);

  // The animation's JSON.
  nlohmann::ordered_json Take() { return std::move(json_); }

 private:
  void AddTrack(int node, const char* path, int values);

  GltfWriter& writer_;
  nlohmann::ordered_json json_;
  int times_;  // accessor
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_WRITER_H_
