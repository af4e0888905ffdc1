#include "model/formats/usd/usda_export.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/formats/usd/usda_writer.h"
#include "model/motion/recorded_motion.h"
#include "model/retargeting/mannequin.h"
#include "model/retargeting/mannequin_look.h"
#include "model/retargeting/rig_animation.h"

namespace duet::formats::usd {
namespace {

using retargeting::Look;
using retargeting::Quaternion;
using retargeting::RigAnimation;
using retargeting::RigPose;
using retargeting::SkinnedMesh;
using retargeting::Vec3d;
using Texts = std::vector<std::string>;

// Margin of a body around its joints, in metres.
constexpr double kAroundJoints = 0.25;

template <typename Values, typename Write>
std::string ArrayOf(const Values& values, Write write) {
  Texts texts;
  for (const auto& value : values) texts.push_back(write(value));
  return UsdArray(texts);
}

std::string Whole(int value) { return absl::StrCat(value); }

std::string Box(const std::vector<Vec3d>& points, double margin) {
  Vec3d low = points[0], high = points[0];
  for (const Vec3d& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3d by = {margin, margin, margin};
  return UsdArray({UsdVector(low - by), UsdVector(high + by)});
}

// The path of every joint from the root, "torso/torso_to_neck/neck". Paths are unique.
Texts JointPaths(const retargeting::Rig& rig) {
  Texts paths;
  std::set<std::string> taken;
  for (const retargeting::RigJoint& joint : rig.joints) {
    const std::string above =
        joint.parent < 0 ? "" : paths[static_cast<std::size_t>(joint.parent)] + "/";
    std::string path = above + PrimName(joint.name);
    while (!taken.insert(path).second) path += "_";
    paths.push_back(path);
  }
  return paths;
}

// Writes weights by class, one value for each key. A class that a key omits has weight 0.
void WriteLabels(const std::vector<motion::Provenance::Labels>& labels, UsdaWriter* out) {
  Texts frames;
  std::map<std::string, Texts> weights;
  for (const auto& key : labels) {
    for (const auto& [interaction_class, weight] : key.weights) {
      weights[interaction_class].resize(labels.size(), "0");
    }
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    frames.push_back(Whole(labels[i].frame));
    for (const auto& [interaction_class, weight] : labels[i].weights) {
      weights[interaction_class][i] = UsdNumber(static_cast<double>(weight));
    }
  }
  out->Open("dictionary labels =");
  out->Line(absl::StrCat("int[] frames = ", UsdArray(frames)));
  out->Open("dictionary weights =");
  for (const auto& [interaction_class, values] : weights) {
    out->Line(absl::StrCat("double[] ", UsdString(interaction_class), " = ", UsdArray(values)));
  }
  out->Close();
  out->Close();
}

void WriteProvenance(const motion::Provenance& provenance, UsdaWriter* out) {
  out->Open("customData =");
  out->Line(absl::StrCat("string model = ",
                         UsdString(absl::StrCat(provenance.model, "@", provenance.model_version))));
  WriteLabels(provenance.labels, out);
  out->Line(absl::StrCat("uint64 seed = ", provenance.seed));
  out->Line(absl::StrCat("double variety = ", UsdNumber(static_cast<double>(provenance.variety))));
  if (provenance.candidates != 1) {
    out->Line(absl::StrCat("int candidates = ", provenance.candidates));
  }
  out->Line(absl::StrCat("bool cleaned_up = ", provenance.cleaned_up ? "true" : "false"));
  out->Close();
}

class UsdaExporter {
 public:
  explicit UsdaExporter(const motion::Skeleton& skeleton) : skeleton_(skeleton) {}

  std::string Export(const std::vector<motion::Clip>& people,
                     const motion::Provenance* provenance) {
    const bool alone = people.size() == 1;
    top_ = alone ? "person_alone" : "pair";
    WriteLayer(people[0]);
    out_.Open(absl::StrCat("def Xform ", UsdString(top_)), '(');
    out_.Line("kind = \"component\"");
    if (provenance != nullptr) WriteProvenance(*provenance, &out_);
    out_.Close(")");
    out_.Open("");
    for (std::size_t i = 0; i < people.size(); ++i) {
      WritePerson(alone ? "person" : i == 0 ? "leader" : "follower", people[i]);
    }
    WriteMaterials(alone);
    out_.Close();
    return out_.Take();
  }

 private:
  void WriteLayer(const motion::Clip& clip) {
    const std::string rate = UsdNumber(clip.frame_rate_hz);
    out_.Open("", '(');
    out_.Line("doc = \"Duet\"");
    out_.Line(absl::StrCat("defaultPrim = ", UsdString(top_)));
    out_.Line("metersPerUnit = 1");
    out_.Line("upAxis = \"Y\"");
    out_.Line("startTimeCode = 0");
    out_.Line(absl::StrCat("endTimeCode = ", clip.frame_count() - 1));
    out_.Line(absl::StrCat("timeCodesPerSecond = ", rate));
    out_.Line(absl::StrCat("framesPerSecond = ", rate));
    out_.Close(")");
  }

  void WritePerson(const std::string& name, const motion::Clip& clip) {
    const RigAnimation animation = retargeting::AnimateRig(skeleton_, clip);
    const std::string path = absl::StrCat("/", top_, "/", name);
    std::vector<Vec3d> everywhere;
    for (const motion::Vec3& p : clip.poses.all()) everywhere.push_back(retargeting::ToDouble(p));
    out_.Open(absl::StrCat("def SkelRoot ", UsdString(name)));
    out_.Line(absl::StrCat("float3[] extent = ", Box(everywhere, kAroundJoints)));
    WriteSkeleton(path, animation);
    const retargeting::Mannequin mannequin =
        MakeMannequin(skeleton_, animation.rig, animation.rest_positions, animation.sole_depth);
    WriteMesh("mannequin", path, name, mannequin.body);
    if (!mannequin.visor.indices.empty()) WriteMesh("visor", path, "visor", mannequin.visor);
    out_.Close();
  }

  // No joint is rotated at rest, so every transform is a translation.
  void WriteSkeleton(const std::string& path, const RigAnimation& animation) {
    const retargeting::Rig& rig = animation.rig;
    const std::string joints = ArrayOf(JointPaths(rig), UsdString);
    Texts rest;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
      rest.push_back(UsdTranslation(animation.RestTranslation(j)));
    }
    OpenBound("Skeleton", "skeleton", "\"SkelBindingAPI\"");
    out_.Line(absl::StrCat("uniform token[] joints = ", joints));
    out_.Line(absl::StrCat("uniform token[] jointNames = ",
                           ArrayOf(rig.joints, [](const retargeting::RigJoint& joint) {
                             return UsdString(joint.name);
                           })));
    out_.Line(absl::StrCat("uniform matrix4d[] bindTransforms = ",
                           ArrayOf(animation.rest_positions, UsdTranslation)));
    out_.Line(absl::StrCat("uniform matrix4d[] restTransforms = ", UsdArray(rest)));
    out_.Line(absl::StrCat("rel skel:animationSource = <", path, "/skeleton/animation>"));
    WriteAnimation(joints, animation);
    out_.Close();
  }

  void WriteAnimation(const std::string& joints, const RigAnimation& animation) {
    Texts turns, places;
    for (const RigPose& pose : animation.frames) {
      turns.push_back(ArrayOf(pose.rotations, UsdTurn));
      places.push_back(ArrayOf(pose.translations, UsdVector));
    }
    const Texts scales(animation.rig.joints.size(), "(1, 1, 1)");
    out_.Open("def SkelAnimation \"animation\"");
    out_.Line(absl::StrCat("uniform token[] joints = ", joints));
    out_.Line(absl::StrCat("half3[] scales = ", UsdArray(scales)));
    out_.TimeSamples("quatf[] rotations", turns);
    out_.TimeSamples("float3[] translations", places);
    out_.Close();
  }

  void WriteMesh(const std::string& name, const std::string& person, const std::string& material,
                 const SkinnedMesh& mesh) {
    const Texts triangles(mesh.indices.size() / 3, "3"), weights(mesh.positions.size(), "1");
    OpenBound("Mesh", name, "\"SkelBindingAPI\", \"MaterialBindingAPI\"");
    out_.Line("uniform token subdivisionScheme = \"none\"");
    out_.Line(absl::StrCat("float3[] extent = ", Box(mesh.positions, 0)));
    out_.Line(absl::StrCat("int[] faceVertexCounts = ", UsdArray(triangles)));
    out_.Line(absl::StrCat("int[] faceVertexIndices = ",
                           ArrayOf(mesh.indices, [](uint32_t i) { return absl::StrCat(i); })));
    out_.Line(absl::StrCat("point3f[] points = ", ArrayOf(mesh.positions, UsdVector)));
    WriteVertexValues("normal3f[] normals", ArrayOf(mesh.normals, UsdVector), 0);
    WriteVertexValues("int[] primvars:skel:jointIndices", ArrayOf(mesh.joints, Whole), 1);
    WriteVertexValues("float[] primvars:skel:jointWeights", UsdArray(weights), 1);
    out_.Line(absl::StrCat("matrix4d primvars:skel:geomBindTransform = ", UsdTranslation({})));
    out_.Line(absl::StrCat("rel skel:skeleton = <", person, "/skeleton>"));
    out_.Line(absl::StrCat("rel material:binding = </", top_, "/materials/", material, ">"));
    out_.Close();
  }

  // Writes one value per vertex. Omits elementSize if `elements` is 0.
  void WriteVertexValues(const std::string& name, const std::string& values, int elements) {
    out_.Open(absl::StrCat(name, " = ", values), '(');
    if (elements > 0) out_.Line(absl::StrCat("elementSize = ", elements));
    out_.Line("interpolation = \"vertex\"");
    out_.Close(")");
  }

  // Opens a prim with applied API schemas.
  void OpenBound(const std::string& type, const std::string& name, const std::string& schemas) {
    out_.Open(absl::StrCat("def ", type, " ", UsdString(name)), '(');
    out_.Line(absl::StrCat("prepend apiSchemas = [", schemas, "]"));
    out_.Close(")");
    out_.Open("");
  }

  void WriteMaterials(bool alone) {
    out_.Open("def Scope \"materials\"");
    WriteMaterial(alone ? "person" : "leader", retargeting::kLeaderLook);
    if (!alone) WriteMaterial("follower", retargeting::kFollowerLook);
    WriteMaterial("visor", retargeting::kVisorLook);
    out_.Close();
  }

  void WriteMaterial(const std::string& name, const Look& look) {
    const Vec3d colour = {retargeting::Linear(look.colour.red),
                          retargeting::Linear(look.colour.green),
                          retargeting::Linear(look.colour.blue)};
    out_.Open(absl::StrCat("def Material ", UsdString(name)));
    out_.Line(absl::StrCat("token outputs:surface.connect = </", top_, "/materials/", name,
                           "/surface.outputs:surface>"));
    out_.Open("def Shader \"surface\"");
    out_.Line("uniform token info:id = \"UsdPreviewSurface\"");
    out_.Line(absl::StrCat("color3f inputs:diffuseColor = ", UsdVector(colour)));
    out_.Line("float inputs:metallic = 0");
    out_.Line(absl::StrCat("float inputs:roughness = ", UsdNumber(look.roughness)));
    out_.Line("token outputs:surface");
    out_.Close();
    out_.Close();
  }

  const motion::Skeleton& skeleton_;
  UsdaWriter out_;
  std::string top_;  // the default prim
};

}  // namespace

absl::StatusOr<std::string> FormatUsda(const std::vector<motion::Clip>& people,
                                       const motion::Skeleton& skeleton,
                                       const motion::Provenance* provenance) {
  absl::Status status = CheckPeople(people, skeleton);
  if (!status.ok()) return status;
  return UsdaExporter(skeleton).Export(people, provenance);
}

}  // namespace duet::formats::usd
