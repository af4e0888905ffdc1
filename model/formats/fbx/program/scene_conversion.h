#ifndef DUET_MODEL_FORMATS_FBX_PROGRAM_SCENE_CONVERSION_H_
#define DUET_MODEL_FORMATS_FBX_PROGRAM_SCENE_CONVERSION_H_

#include <string>

#include "absl/status/statusor.h"
#include "assimp/scene.h"
#include "model/retargeting/affine.h"

namespace duet::formats::fbx::program {

struct ConversionOptions {
  bool with_meshes = false;      // adds the skinned meshes
  retargeting::Affine to_world;  // is applied to the scene
};

// Converts a scene to the output of duet-fbx (model/formats/fbx/fbx_program.h): a line of JSON with
// what the file states, and a binary glTF with an animation for each take.
//
// Errors: INVALID_ARGUMENT for more than this project reads.
absl::StatusOr<std::string> ConvertScene(const aiScene& scene, const ConversionOptions& options);

}  // namespace duet::formats::fbx::program

#endif  // DUET_MODEL_FORMATS_FBX_PROGRAM_SCENE_CONVERSION_H_
