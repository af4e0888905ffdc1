#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/formats/gltf/gltf_motion.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/retargeting/mannequin.h"
#include "model/retargeting/rig_fitting.h"

namespace duet::formats::gltf {
namespace {

using nlohmann::ordered_json;
using retargeting::Linear;
using retargeting::Look;
using retargeting::Quaternion;
using retargeting::RigAnimation;
using retargeting::RigPose;
using retargeting::Vec3d;

ordered_json ToArray(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

// No joint is rotated at rest, so a bind matrix is a translation.
int AddSkin(const std::string& name, int first_joint, const std::vector<Vec3d>& rest_positions,
            GltfWriter* writer) {
  std::vector<retargeting::Affine> to_joints;
  ordered_json joints = ordered_json::array();
  for (const Vec3d& position : rest_positions) {
    joints.push_back(first_joint + static_cast<int>(to_joints.size()));
    to_joints.emplace_back().origin = -position;
  }
  writer->BeginView(GltfWriter::Use::kOther);
  const int matrices = writer->AddMatrices(to_joints);
  return writer->Add("skins", {{"name", name},
                               {"inverseBindMatrices", matrices},
                               {"skeleton", first_joint},
                               {"joints", std::move(joints)}});
}

int AddMaterial(const std::string& name, const retargeting::Look& look, GltfWriter* writer) {
  const retargeting::Colour colour = look.colour;
  return writer->Add(
      "materials",
      {{"name", name},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {Linear(colour.red), Linear(colour.green), Linear(colour.blue), 1}},
         {"metallicFactor", 0},
         {"roughnessFactor", look.roughness}}}});
}

ordered_json AddPrimitive(const retargeting::SkinnedMesh& mesh, std::size_t joint_count,
                          int material, GltfWriter* writer) {
  const auto vertices = [writer](auto add) {
    writer->BeginView(GltfWriter::Use::kVertices);
    return add();
  };
  ordered_json attributes;
  attributes["POSITION"] = vertices([&] { return writer->AddPositions(mesh.positions); });
  attributes["NORMAL"] = vertices([&] { return writer->AddVectors(mesh.normals); });
  attributes["JOINTS_0"] =
      vertices([&] { return writer->AddVertexJoints(mesh.joints, joint_count); });
  attributes["WEIGHTS_0"] = vertices([&] { return writer->AddWholeWeights(mesh.joints.size()); });
  writer->BeginView(GltfWriter::Use::kIndices);
  const int indices = writer->AddIndices(mesh.indices, mesh.positions.size());
  return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", material}};
}

ordered_json Extras(const motion::Provenance& provenance) {
  ordered_json labels = ordered_json::array();
  for (const motion::Provenance::Labels& key : provenance.labels) {
    ordered_json weights = ordered_json::object();
    for (const auto& [interaction_class, weight] : key.weights) weights[interaction_class] = weight;
    labels.push_back({{"frame", key.frame}, {"weights", std::move(weights)}});
  }
  ordered_json extras = {{"model", absl::StrCat(provenance.model, "@", provenance.model_version)},
                         {"labels", std::move(labels)},
                         {"seed", provenance.seed},
                         {"variety", provenance.variety}};
  if (provenance.candidates != 1) extras["candidates"] = provenance.candidates;
  extras["cleaned_up"] = provenance.cleaned_up;
  return extras;
}

class GltfExporter {
 public:
  explicit GltfExporter(const motion::Skeleton& skeleton) : skeleton_(skeleton) {}

  std::string Export(const std::vector<motion::Clip>& people, const motion::Provenance* provenance,
                     GltfContainer container) {
    ordered_json scene = {{"name", people.size() == 1 ? "person" : "pair"}};
    const bool alone = people.size() == 1;
    std::vector<Person> all;
    for (std::size_t i = 0; i < people.size(); ++i) {
      const std::string name = alone ? "person" : i == 0 ? "leader" : "follower";
      all.push_back(AddPerson(name, people[i],
                              i == 0 ? retargeting::kLeaderLook : retargeting::kFollowerLook));
      scene["nodes"].push_back(all.back().node);
      scene["nodes"].push_back(all.back().mannequin);
    }
    AddAnimation(people[0], all);
    // The times of keys do not distinguish 29.97 Hz from 30.
    writer_.json()["asset"]["extras"] = {{"frame_rate_hz", people[0].frame_rate_hz}};
    if (provenance != nullptr) scene["extras"] = Extras(*provenance);
    writer_.json()["scene"] = 0;
    writer_.Add("scenes", std::move(scene));
    return container == GltfContainer::kBinary ? writer_.Binary() : writer_.Text();
  }

 private:
  struct Person {
    RigAnimation animation;
    int node = 0;         // parent of the skeleton
    int first_joint = 0;  // node; the others follow in the rig's order
    int mannequin = 0;    // node
  };

  Person AddPerson(const std::string& name, const motion::Clip& clip, const Look& look) {
    Person person;
    person.animation = retargeting::AnimateRig(skeleton_, clip);
    person.node = writer_.Add("nodes", {{"name", name}});
    person.first_joint = person.node + 1;
    AddJoints(person);
    const int skin = AddSkin(name, person.first_joint, person.animation.rest_positions, &writer_);
    const int mesh = AddMesh(name, person.animation, look);
    person.mannequin = writer_.Add(
        "nodes", {{"name", absl::StrCat(name, "_mannequin")}, {"mesh", mesh}, {"skin", skin}});
    return person;
  }

  void AddJoints(const Person& person) {
    const retargeting::Rig& rig = person.animation.rig;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
      const int node =
          writer_.Add("nodes", {{"name", rig.joints[j].name},
                                {"translation", ToArray(person.animation.RestTranslation(j))}});
      const int parent =
          rig.joints[j].parent < 0 ? person.node : person.first_joint + rig.joints[j].parent;
      writer_.json()["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(node);
    }
  }

  int AddMesh(const std::string& name, const RigAnimation& animation, const Look& look) {
    const retargeting::Mannequin mannequin =
        MakeMannequin(skeleton_, animation.rig, animation.rest_positions, animation.sole_depth);
    const std::size_t joints = animation.rig.joints.size();
    ordered_json primitives = ordered_json::array();
    primitives.push_back(
        AddPrimitive(mannequin.body, joints, AddMaterial(name, look, &writer_), &writer_));
    if (!mannequin.visor.indices.empty()) {
      if (visor_ < 0) visor_ = AddMaterial("visor", retargeting::kVisorLook, &writer_);
      primitives.push_back(AddPrimitive(mannequin.visor, joints, visor_, &writer_));
    }
    return writer_.Add("meshes", {{"name", absl::StrCat(name, "_mannequin")},
                                  {"primitives", std::move(primitives)}});
  }

  void AddAnimation(const motion::Clip& clip, const std::vector<Person>& people) {
    AnimationWriter animation("duet", static_cast<std::size_t>(clip.frame_count()),
                              clip.frame_rate_hz, &writer_);
    for (const Person& person : people) AddTracks(person, &animation);
    writer_.Add("animations", animation.Take());
  }

  static void AddTracks(const Person& person, AnimationWriter* tracks) {
    const RigAnimation& animation = person.animation;
    for (std::size_t j = 0; j < animation.rig.joints.size(); ++j) {
      const int node = person.first_joint + static_cast<int>(j);
      if (j == 0 || !animation.KeepsItsPlace(j)) {
        std::vector<Vec3d> translations;
        for (const RigPose& pose : animation.frames) translations.push_back(pose.translations[j]);
        tracks->Translate(node, translations);
      }
      if (j == 0 || !animation.NeverTurns(j)) {
        std::vector<Quaternion> rotations;
        for (const RigPose& pose : animation.frames) rotations.push_back(pose.rotations[j]);
        tracks->Rotate(node, rotations);
      }
    }
  }

  const motion::Skeleton& skeleton_;
  GltfWriter writer_;
  int visor_ = -1;  // material
};

}  // namespace

std::string FormatGltf(const std::vector<motion::Clip>& people, const motion::Skeleton& skeleton,
                       const motion::Provenance* provenance, GltfContainer container) {
  return GltfExporter(skeleton).Export(people, provenance, container);
}

}  // namespace duet::formats::gltf
