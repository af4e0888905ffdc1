#include "contrib/formats/tests/fbx/text_fbx.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/angle.h"
#include "model/motion/skeleton.h"

namespace duet::test {
namespace {

using retargeting::Affine;
using retargeting::AxisAngle;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr std::int64_t kSecond = 46186158000;  // of FbxTime
constexpr int kModel = 1000, kTake = 50000, kCurveNode = 100000;
constexpr int kMesh = 9000, kGeometry = 9001, kSkin = 9002;

constexpr char kHeader[] = R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",1
		P: "UpAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",100
		P: "TimeMode", "enum", "", "",6
	}
}
Documents:  {
	Count: 1
	Document: 1, "", "Scene" {
		RootNode: 0
	}
}
Definitions:  {
	Version: 100
}
Objects:  {
)";

Vec3d Property(const FbxBone& bone, const std::string& name) {
  const auto found = bone.properties.find(name);
  const bool is_scale = name == "Lcl Scaling" || name == "GeometricScaling";
  return found != bone.properties.end() ? found->second : is_scale ? Vec3d{1, 1, 1} : Vec3d{};
}

std::string Three(Vec3d a) { return absl::StrFormat("%.9g,%.9g,%.9g", a.x, a.y, a.z); }

void AddModel(std::size_t index, const FbxBone& bone, const char* kind, std::string* objects) {
  absl::StrAppend(objects, "\tModel: ", kModel + index, ", \"Model::", bone.name, "\", \"", kind,
                  "\" {\n\t\tVersion: 232\n\t\tProperties70:  {\n",
                  "\t\t\tP: \"RotationOrder\", \"enum\", \"\", \"\",", bone.rotation_order,
                  "\n\t\t\tP: \"InheritType\", \"enum\", \"\", \"\",", bone.inherit_type, "\n");
  for (const auto& [name, value] : bone.properties) {
    absl::StrAppend(objects, "\t\t\tP: \"", name, "\", \"Vector3D\", \"Vector\", \"\",",
                    Three(value), "\n");
  }
  absl::StrAppend(objects, "\t\t}\n\t}\n");
}

// Writes a curve of one axis and connects it.
void AddCurve(int id, int node, char axis, const std::vector<double>& keys, int first_frame,
              std::string* objects, std::string* connections) {
  std::string times, values;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto frame = static_cast<double>(first_frame + static_cast<int>(k));
    absl::StrAppend(&times, k == 0 ? "" : ",",
                    static_cast<std::int64_t>(frame / kTextFbxRateHz * kSecond));
    absl::StrAppend(&values, k == 0 ? "" : ",", absl::StrFormat("%.9g", keys[k]));
  }
  absl::StrAppend(objects, "\tAnimationCurve: ", id, ", \"AnimCurve::\", \"\" {\n\t\tKeyTime: *",
                  keys.size(), " {\n\t\t\ta: ", times, "\n\t\t}\n\t\tKeyValueFloat: *", keys.size(),
                  " {\n\t\t\ta: ", values, "\n\t\t}\n\t}\n");
  absl::StrAppend(connections, "\tC: \"OP\",", id, ",", node, ", \"d|", std::string(1, axis),
                  "\"\n");
}

void AddTake(const FbxTake& take, int take_id, int* next, std::string* objects,
             std::string* connections) {
  std::size_t frames = 1;
  for (const FbxTrack& track : take.tracks) frames = std::max(frames, track.keys.size());
  const double last = static_cast<double>(take.first_frame) + static_cast<double>(frames) - 1;
  absl::StrAppend(objects, "\tAnimationStack: ", take_id, ", \"AnimStack::", take.name,
                  "\", \"\" {\n\t\tProperties70:  {\n",
                  "\t\t\tP: \"LocalStart\", \"KTime\", \"Time\", \"\",0\n",
                  "\t\t\tP: \"LocalStop\", \"KTime\", \"Time\", \"\",",
                  static_cast<std::int64_t>(last / kTextFbxRateHz * kSecond), "\n\t\t}\n\t}\n",
                  "\tAnimationLayer: ", take_id + 1, ", \"AnimLayer::Base\", \"\" {\n\t}\n");
  absl::StrAppend(connections, "\tC: \"OO\",", take_id + 1, ",", take_id, "\n");
  for (const FbxTrack& track : take.tracks) {
    const int node = (*next)++;
    absl::StrAppend(objects, "\tAnimationCurveNode: ", node,
                    ", \"AnimCurveNode::", track.property.substr(4, 1), "\", \"\" {\n\t}\n");
    absl::StrAppend(connections, "\tC: \"OO\",", node, ",", take_id + 1, "\n\tC: \"OP\",", node,
                    ",", kModel + track.bone, ", \"", track.property, "\"\n");
    std::array<std::vector<double>, 3> axes;
    for (const Vec3d& key : track.keys) {
      axes[0].push_back(key.x);
      axes[1].push_back(key.y);
      axes[2].push_back(key.z);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      AddCurve((*next)++, node, "XYZ"[axis], axes[axis], take.first_frame, objects, connections);
    }
  }
}

// Degrees; the first axis of the order turns first.
Quaternion Euler(Vec3d degrees, int order) {
  const Quaternion x = AxisAngle({1, 0, 0}, degrees.x * base::kRadiansPerDegree);
  const Quaternion y = AxisAngle({0, 1, 0}, degrees.y * base::kRadiansPerDegree);
  const Quaternion z = AxisAngle({0, 0, 1}, degrees.z * base::kRadiansPerDegree);
  switch (order) {
    case 1:
      return y * z * x;
    case 2:
      return x * z * y;
    case 3:
      return z * x * y;
    case 4:
      return y * x * z;
    case 5:
      return x * y * z;
    default:
      return z * y * x;
  }
}

Affine Moved(Vec3d by) { return retargeting::FromParts({by, {}, {1, 1, 1}}); }
Affine Turned(Quaternion turn) { return retargeting::FromParts({{}, turn, {1, 1, 1}}); }
Affine Scaled(Vec3d scale) { return retargeting::FromParts({{}, {}, scale}); }
Affine Undone(const Affine& map) { return *retargeting::Inverse(map); }

// A node's global transform and its parts, named as in the FBX SDK's sample "Transformations".
struct Global {
  Affine transform, rotation, scale, own_scale;
};

Global GlobalOf(const FbxBone& bone, const FbxTake& take, int index, int frame,
                const Global& parent) {
  const auto now = [&](const std::string& property) {
    for (const FbxTrack& track : take.tracks) {
      if (track.bone == index && track.property == property) {
        return track.keys[static_cast<std::size_t>(frame)];
      }
    }
    return Property(bone, property);
  };
  const Affine pre = Turned(Euler(now("PreRotation"), 0));
  const Affine post = Turned(Euler(now("PostRotation"), 0));
  const Affine turn = Turned(Euler(now("Lcl Rotation"), bone.rotation_order));
  const Affine scale = Scaled(now("Lcl Scaling"));
  const Affine rotation_pivot = Moved(now("RotationPivot"));
  const Affine scaling_pivot = Moved(now("ScalingPivot"));
  const Affine local_turn = pre * turn * Undone(post);
  const Affine local = Moved(now("Lcl Translation")) * Moved(now("RotationOffset")) *
                       rotation_pivot * local_turn * Undone(rotation_pivot) *
                       Moved(now("ScalingOffset")) * scaling_pivot * scale * Undone(scaling_pivot);
  Global global;
  global.own_scale = scale;
  global.rotation = parent.rotation * local_turn;
  Affine linear;
  if (bone.inherit_type == 0) {
    linear = parent.rotation * local_turn * parent.scale * scale;
  } else if (bone.inherit_type == 2) {
    linear = parent.rotation * local_turn * parent.scale * Undone(parent.own_scale) * scale;
  } else {
    linear = parent.rotation * parent.scale * local_turn * scale;
  }
  global.scale = Undone(global.rotation) * linear;
  global.transform = linear;
  global.transform.origin = parent.transform.origin + parent.transform.Turn(local.origin);
  return global;
}

std::vector<Affine> Transforms(const std::vector<FbxBone>& bones, const FbxTake& take, int frame) {
  std::vector<Global> globals;
  std::vector<Affine> transforms;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const Global parent =
        bones[b].parent < 0 ? Global() : globals[static_cast<std::size_t>(bones[b].parent)];
    globals.push_back(GlobalOf(bones[b], take, static_cast<int>(b), frame, parent));
    transforms.push_back(globals.back().transform);
  }
  return transforms;
}

std::string Array(const std::vector<double>& numbers) {
  std::string text = absl::StrCat("*", numbers.size(), " {\n\t\t\ta: ");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    absl::StrAppend(&text, i == 0 ? "" : ",", absl::StrFormat("%.9g", numbers[i]));
  }
  return text + "\n\t\t}\n";
}

std::string Matrix(const Affine& map) {
  return Array({map.x.x, map.x.y, map.x.z, 0, map.y.x, map.y.y, map.y.z, 0, map.z.x, map.z.y,
                map.z.z, 0, map.origin.x, map.origin.y, map.origin.z, 1});
}

void AddSkin(const FbxSkin& skin, std::string* objects, std::string* connections) {
  const std::vector<Affine> bound = Transforms(skin.bound, {}, 0);
  const Affine mesh = Transforms({skin.mesh}, {}, 0)[0];
  std::vector<double> vertices, corners;
  std::string clusters;
  absl::StrAppend(connections, "\tC: \"OO\",", kMesh, ",0\n\tC: \"OO\",", kGeometry, ",", kMesh,
                  "\n\tC: \"OO\",", kSkin, ",", kGeometry, "\n");
  for (std::size_t b = 0; b < bound.size(); ++b) {
    const double first = 3.0 * static_cast<double>(b);
    vertices.insert(vertices.end(), {first, 0, 0, first, 1, 0, first, 0, 1});
    corners.insert(corners.end(), {first, first + 1, -(first + 2) - 1});
    absl::StrAppend(
        &clusters, "\tDeformer: ", kSkin + 1 + b,
        ", \"SubDeformer::\", \"Cluster\" {\n\t\tIndexes: ", Array({first, first + 1, first + 2}),
        "\t\tWeights: ", Array({1, 1, 1}), "\t\tTransform: ", Matrix(Undone(bound[b]) * mesh),
        "\t\tTransformLink: ", Matrix(bound[b]), "\t}\n");
    absl::StrAppend(connections, "\tC: \"OO\",", kSkin + 1 + b, ",", kSkin, "\n\tC: \"OO\",",
                    kModel + b, ",", kSkin + 1 + b, "\n");
  }
  AddModel(kMesh - kModel, skin.mesh, "Mesh", objects);
  absl::StrAppend(objects, "\tGeometry: ", kGeometry,
                  ", \"Geometry::\", \"Mesh\" {\n\t\tVertices: ", Array(vertices),
                  "\t\tPolygonVertexIndex: ", Array(corners), "\t}\n\tDeformer: ", kSkin,
                  ", \"Deformer::\", \"Skin\" {\n\t}\n", clusters);
}

}  // namespace

std::string TextFbx(const std::vector<FbxBone>& bones, const std::vector<FbxTake>& takes,
                    const FbxSkin* skin) {
  std::string objects, connections;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    AddModel(b, bones[b], "LimbNode", &objects);
    absl::StrAppend(&connections, "\tC: \"OO\",", kModel + b, ",",
                    bones[b].parent < 0 ? 0 : kModel + bones[b].parent, "\n");
  }
  if (skin != nullptr) AddSkin(*skin, &objects, &connections);
  int next = kCurveNode, take_id = kTake;
  for (const FbxTake& take : takes) {
    AddTake(take, take_id, &next, &objects, &connections);
    take_id += 2;
  }
  return absl::StrCat(kHeader, objects, "}\nConnections:  {\n", connections, "}\n");
}

std::vector<motion::Vec3> FbxWorld(const std::vector<FbxBone>& bones, const FbxTake& take,
                                   int frame) {
  std::vector<motion::Vec3> places;
  for (const Affine& transform : Transforms(bones, take, frame)) {
    places.push_back(ToFloat(transform.origin));
  }
  return places;
}

std::vector<FbxBone> FbxPerson(const std::vector<motion::Vec3>& pose) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const std::vector<int> parents = skeleton.Parents();
  std::vector<FbxBone> bones;
  std::vector<int> places(parents.size(), -1);
  while (bones.size() < parents.size()) {
    for (std::size_t joint = 0; joint < parents.size(); ++joint) {
      const int parent = parents[joint];
      if (places[joint] >= 0) continue;
      if (parent >= 0 && places[static_cast<std::size_t>(parent)] < 0) continue;
      const motion::Vec3 above =
          parent < 0 ? motion::Vec3{} : pose[static_cast<std::size_t>(parent)];
      places[joint] = static_cast<int>(bones.size());
      bones.push_back({skeleton.joint_names[joint],
                       parent < 0 ? -1 : places[static_cast<std::size_t>(parent)],
                       {{"Lcl Translation", retargeting::ToDouble(pose[joint] - above)}}});
    }
  }
  return bones;
}

}  // namespace duet::test
