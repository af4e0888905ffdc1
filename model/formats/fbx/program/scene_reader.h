#ifndef DUET_MODEL_FORMATS_FBX_PROGRAM_SCENE_READER_H_
#define DUET_MODEL_FORMATS_FBX_PROGRAM_SCENE_READER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "assimp/scene.h"

namespace Assimp {
class Importer;
}  // namespace Assimp

namespace duet::formats::fbx::program {

// Reads a file with assimp's reader of FBX; its other readers are not used, whatever the bytes are.
class SceneReader {
 public:
  SceneReader();
  ~SceneReader();

  // The scene belongs to this object. Errors: INVALID_ARGUMENT with assimp's message.
  absl::StatusOr<const aiScene*> Read(const std::string& content);

 private:
  std::unique_ptr<Assimp::Importer> importer_;
};

}  // namespace duet::formats::fbx::program

#endif  // DUET_MODEL_FORMATS_FBX_PROGRAM_SCENE_READER_H_
