#include "model/formats/fbx/fbx_import.h"

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/formats/gltf/gltf_document.h"

namespace duet::formats::fbx {
namespace {

constexpr double kCentimetre = 0.01;  // metres

}  // namespace

absl::StatusOr<std::string> NoFileBeside(const std::string& name) {
  return absl::NotFoundError(absl::StrCat(name, ": expected no file beside FBX"));
}

gltf::GltfImportOptions GltfOptionsOf(const FbxScene& scene, const FbxImportOptions& options) {
  gltf::GltfImportOptions gltf{options, options.person, options.frame_rate_hz};
  gltf.animation = options.animation;
  gltf.stated_frame_rate_hz = scene.frame_rate_hz;
  if (scene.unit_scale_factor.has_value()) {
    gltf.stated_metres_per_unit = kCentimetre * *scene.unit_scale_factor;
    gltf.stated_by = absl::StrCat("UnitScaleFactor ", *scene.unit_scale_factor);
  }
  if (!gltf.up_axis.has_value()) gltf.up_axis = scene.up_axis;
  return gltf;
}

absl::StatusOr<motion::Clip> FromFbx(absl::string_view content, absl::string_view source,
                                     const FbxImportOptions& options) {
  const absl::StatusOr<FbxScene> scene = ConvertFbx(content, source);
  if (!scene.ok()) return scene.status();
  const absl::StatusOr<gltf::GltfDocument> document = gltf::ParseGltf(scene->glb, source);
  if (!document.ok()) return document.status();
  absl::StatusOr<motion::Clip> clip =
      FromGltf(*document, source, NoFileBeside, GltfOptionsOf(*scene, options));
  const bool stated = !options.up_axis.has_value() && scene->up_axis.has_value();
  if (stated && options.report != nullptr && options.report->up_axis.has_value()) {
    options.report->up_axis->origin = retargeting::Origin::kFile;
  }
  return clip;
}

}  // namespace duet::formats::fbx
