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

// What GltfDocument::writer says of Duet's own files.
inline constexpr char kDuetsWriter[] = "Duet";

// A glTF document in the making: its JSON, and one buffer that grows.
class GltfWriter {
 public:
  GltfWriter();
  // Goes on from a document with one buffer.
  GltfWriter(nlohmann::ordered_json json, std::string buffer)
      : json_(std::move(json)), buffer_(std::move(buffer)) {}

  // Members of the document, by the format's names.
  nlohmann::ordered_json& json() { return json_; }
  // Adds to an array of the document ("nodes") and returns the index.
  int Add(const char* array, nlohmann::ordered_json value);

  // What the bytes of a view are for; the format wants it of meshes alone.
  enum class Use { kOther, kVertices, kIndices };
  // Accessors that are added from here on are in a view of their own.
  void BeginView(Use use);

  // Each returns the accessor. The values go to the end of the buffer.
  int AddTimes(const std::vector<float>& seconds);  // with their range
  int AddVectors(const std::vector<retargeting::Vec3d>& vectors);
  int AddPositions(const std::vector<retargeting::Vec3d>& positions);  // with their range
  int AddRotations(const std::vector<retargeting::Quaternion>& rotations);
  int AddTranslationMatrices(const std::vector<retargeting::Vec3d>& translations);
  int AddIndices(const std::vector<uint32_t>& indices, std::size_t vertices);
  // Each vertex with one joint, and the whole weight on it.
  int AddVertexJoints(const std::vector<int>& joints, std::size_t joint_count);
  int AddWholeWeights(std::size_t vertices);

  // The file: binary, or text with the buffer inside.
  std::string Binary();
  std::string Text();

 private:
  // Adds an accessor for what is appended after it.
  int AddAccessor(int component_type, const char* type, std::size_t count);
  void Append(float value);
  template <typename T>
  void AppendWhole(T value);
  // To a multiple of four, and into the view.
  void EndAccessor();

  nlohmann::ordered_json json_;
  std::string buffer_;
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_WRITER_H_
