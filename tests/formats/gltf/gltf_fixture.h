#ifndef DUET_TESTS_FORMATS_GLTF_GLTF_FIXTURE_H_
#define DUET_TESTS_FORMATS_GLTF_GLTF_FIXTURE_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/motion/clip.h"

namespace duet::test {

// A glTF document in the making: its JSON, and one buffer.
class GltfBuilder {
 public:
  GltfBuilder();

  nlohmann::json& json() { return json_; }
  std::string& buffer() { return buffer_; }
  // Indices of what was added.
  int AddAccessor(const std::vector<float>& values, const std::string& type);
  int AddNode(nlohmann::json node);

  // The three ways in which a file has its buffer.
  std::string WithDataUri() const;
  std::string WithFile(const std::string& uri) const;
  std::string Binary() const;

 private:
  nlohmann::json json_;
  std::string buffer_;
};

struct GltfPersonOptions {
  std::string interpolation = "LINEAR";
  // Bones in centimetres below a node that scales them, as Blender writes Mixamo's characters.
  bool centimetres_below_an_armature = false;
  bool with_skin = true;
  std::string name_prefix;
  std::string animation = "walk";
};

// Adds a person who moves as the clip does, with a key for each frame.
void AddPerson(const motion::Clip& clip, const GltfPersonOptions& options, GltfBuilder* builder);

// A .glb of these chunks, whatever they are.
std::string BinaryGltf(const std::string& json, const std::string& binary);

}  // namespace duet::test

#endif  // DUET_TESTS_FORMATS_GLTF_GLTF_FIXTURE_H_
