#include "model/formats/fbx/program/scene_reader.h"

#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "assimp/BaseImporter.h"
#include "assimp/Importer.hpp"
#include "assimp/config.h"
#include "assimp/importerdesc.h"
#include "assimp/postprocess.h"
#include "model/base/printable.h"

namespace duet::formats::fbx::program {
namespace {

constexpr std::size_t kLongestMessage = 200;

}  // namespace

SceneReader::SceneReader() : importer_(std::make_unique<Assimp::Importer>()) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer_->GetImporterCount(); ++i) {
    const std::string extensions = importer_->GetImporterInfo(i)->mFileExtensions;
    if (extensions != "fbx") others.push_back(importer_->GetImporter(i));
  }
  for (Assimp::BaseImporter* other : others) {
    importer_->UnregisterLoader(other);
    delete other;
  }
  // Without its own nodes, assimp drops pivots from animations.
  importer_->SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  importer_->SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
}

SceneReader::~SceneReader() = default;

absl::StatusOr<const aiScene*> SceneReader::Read(const std::string& content) {
  const aiScene* scene = importer_->ReadFileFromMemory(
      content.data(), content.size(), aiProcess_Triangulate | aiProcess_LimitBoneWeights, "fbx");
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected FBX 7.1 or later, binary or text, got a file that assimp rejects: ",
                     base::Printable(importer_->GetErrorString(), kLongestMessage)));
  }
  return scene;
}

}  // namespace duet::formats::fbx::program
