#include "model/formats/fbx/fbx_rig.h"

#include <vector>

#include "model/formats/fbx/fbx_program.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/character.h"

namespace duet::formats::fbx {
namespace {

// The unit, axis and joints with which the file is read.
absl::StatusOr<retargeting::CharacterFit> FitOf(const FbxScene& scene, absl::string_view source,
                                                const FbxImportOptions& options) {
  const absl::StatusOr<gltf::GltfDocument> document = gltf::ParseGltf(scene.glb, source);
  if (!document.ok()) return document.status();
  retargeting::CharacterFit fit;
  std::vector<int> nodes;
  gltf::GltfImportOptions reading = GltfOptionsOf(scene, options);
  reading.fit = &fit;
  reading.nodes = &nodes;
  const absl::StatusOr<motion::Clip> read = FromGltf(*document, source, NoFileBeside, reading);
  if (!read.ok()) return read.status();
  return fit;
}

}  // namespace

absl::StatusOr<retargeting::CharacterRig> ReadFbxRig(absl::string_view content,
                                                     absl::string_view source,
                                                     const FbxImportOptions& options) {
  const absl::StatusOr<FbxScene> scene = ConvertFbx(content, source);
  if (!scene.ok()) return scene.status();
  return gltf::ReadGltfRig(scene->glb, source, NoFileBeside, GltfOptionsOf(*scene, options));
}

absl::StatusOr<std::string> OntoFbxRig(const motion::Clip& clip, absl::string_view content,
                                       absl::string_view source, const FbxImportOptions& options,
                                       gltf::GltfContainer container) {
  const absl::StatusOr<FbxScene> scene = ConvertFbx(content, source);
  if (!scene.ok()) return scene.status();
  const absl::StatusOr<retargeting::CharacterFit> fit = FitOf(*scene, source, options);
  if (!fit.ok()) return fit.status();
  const absl::StatusOr<FbxScene> in_world =
      ConvertFbx(content, source, FbxMeshes{fit->metres_per_unit, fit->up_axis});
  if (!in_world.ok()) return in_world.status();
  gltf::GltfImportOptions reading = GltfOptionsOf(*in_world, options);
  reading.metres_per_unit = 1;
  reading.up_axis = motion::UpAxis::kYUp;
  reading.notes = nullptr;  // FitOf added them
  return gltf::OntoGltfRig(clip, in_world->glb, source, NoFileBeside, reading, container);
}

}  // namespace duet::formats::fbx
