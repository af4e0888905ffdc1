#include "contrib/formats/usd/usda_export.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "model/base/text.h"
#include "model/motion/recorded_motion.h"
#include "model/retargeting/mannequin.h"
#include "model/retargeting/rig_animation.h"

namespace duet::contrib::formats::usd {
namespace {

using retargeting::Look;
using retargeting::Quaternion;
using retargeting::RigAnimation;
using retargeting::RigPose;
using retargeting::SkinnedMesh;
using retargeting::Vec3d;
using Texts = std::vector<std::string>;

constexpr std::size_t kIndent = 4;
// Margin of a body around its joints, in metres.
constexpr double kAroundJoints = 0.25;

// Converts a name to a valid prim name: letters, digits and underscores; not a digit first.
std::string PrimName(absl::string_view name) {
  std::string prim;
  for (const char c : name) prim += absl::ascii_isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (prim.empty() || absl::ascii_isdigit(static_cast<unsigned char>(prim[0]))) prim = "_" + prim;
  return prim;
}

// Quotes any text with double quotes.
std::string UsdString(absl::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      absl::StrAppendFormat(&quoted, "\\x%02x", byte);
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string UsdNumber(double value) {
  std::string text;
  base::AppendNumber(&text, static_cast<float>(value) + 0.0f);  // no minus before zero
  return text;
}

std::string UsdVector(Vec3d a) {
  return absl::StrCat("(", UsdNumber(a.x), ", ", UsdNumber(a.y), ", ", UsdNumber(a.z), ")");
}

// The real part first.
std::string UsdTurn(Quaternion q) {
  return absl::StrCat("(", UsdNumber(q.w), ", ", UsdNumber(q.x), ", ", UsdNumber(q.y), ", ",
                      UsdNumber(q.z), ")");
}

// A matrix for row vectors.
std::string UsdTranslation(Vec3d by) {
  return absl::StrCat("((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (", UsdNumber(by.x), ", ",
                      UsdNumber(by.y), ", ", UsdNumber(by.z), ", 1))");
}

std::string UsdArray(const Texts& values) {
  return absl::StrCat("[", absl::StrJoin(values, ", "), "]");
}

// Builds text USD line by line.
class UsdaWriter {
 public:
  // Adds an indented line.
  void Line(absl::string_view text) {
    text_.append(kIndent * depth_, ' ');
    absl::StrAppend(&text_, text, "\n");
  }
  // Adds a line that ends with `bracket` ("{" or "("), and indents the next lines until Close.
  void Open(absl::string_view text, char bracket = '{') {
    Line(absl::StrCat(text, text.empty() ? "" : " ", std::string(1, bracket)));
    ++depth_;
  }
  void Close(absl::string_view bracket = "}") {
    --depth_;
    Line(bracket);
  }
  // Adds "name.timeSamples = {" with a line for each of `values`, at frames 0, 1, 2, ...
  void TimeSamples(absl::string_view name, const Texts& values) {
    Open(absl::StrCat(name, ".timeSamples ="));
    for (std::size_t frame = 0; frame < values.size(); ++frame) {
      Line(absl::StrCat(frame, ": ", values[frame], ","));
    }
    Close();
  }

  std::string Take() { return std::move(text_); }

 private:
  std::string text_ = "#usda 1.0\n";
  std::size_t depth_ = 0;
};

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

class UsdaExporter {
 public:
  explicit UsdaExporter(const motion::Skeleton& skeleton) : skeleton_(skeleton) {}

  std::string Export(const std::vector<motion::Clip>& people) {
    const bool alone = people.size() == 1;
    top_ = alone ? "person_alone" : "pair";
    WriteLayer(people[0]);
    out_.Open(absl::StrCat("def Xform ", UsdString(top_)), '(');
    out_.Line("kind = \"component\"");
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
                                       const motion::Skeleton& skeleton) {
  absl::Status status = CheckPeople(people, skeleton);
  if (!status.ok()) return status;
  return UsdaExporter(skeleton).Export(people);
}

}  // namespace duet::contrib::formats::usd
