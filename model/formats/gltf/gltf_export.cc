#include "model/formats/gltf/gltf_export.h"

#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/recorded_motion.h"
#include "model/retargeting/mannequin.h"
#include "model/retargeting/mannequin_look.h"
#include "model/retargeting/rig_animation.h"

namespace duet::formats::gltf {
namespace {

using nlohmann::ordered_json;
using retargeting::Linear;
using retargeting::Look;
using retargeting::Quaternion;
using retargeting::RigAnimation;
using retargeting::RigPose;
using retargeting::Vec3d;

ordered_json Array(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

ordered_json Extras(const motion::Provenance& provenance) {
  ordered_json labels = ordered_json::array();
  for (const motion::Provenance::Labels& key : provenance.labels) {
    ordered_json weights = ordered_json::object();
    for (const auto& [interaction_class, weight] : key.weights) weights[interaction_class] = weight;
    labels.push_back({{"frame", key.frame}, {"weights", std::move(weights)}});
  }
  return {{"model", absl::StrCat(provenance.model, "@", provenance.model_version)},
          {"labels", std::move(labels)},
          {"seed", provenance.seed},
          {"variety", provenance.variety},
          {"cleaned_up", provenance.cleaned_up}};
}

class GltfExporter {
 public:
  explicit GltfExporter(const motion::Skeleton& skeleton) : skeleton_(skeleton) {
    animation_ = {
        {"name", "duet"}, {"channels", ordered_json::array()}, {"samplers", ordered_json::array()}};
  }

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
    // Keys alone do not tell 29.97 Hz from 30.
    writer_.json()["asset"]["extras"] = {{"frame_rate_hz", people[0].frame_rate_hz}};
    if (provenance != nullptr) scene["extras"] = Extras(*provenance);
    writer_.json()["scene"] = 0;
    writer_.Add("scenes", std::move(scene));
    return container == GltfContainer::kBinary ? writer_.Binary() : writer_.Text();
  }

 private:
  struct Person {
    RigAnimation animation;
    int node = 0;         // what the skeleton hangs from
    int first_joint = 0;  // node; the others follow in the rig's order
    int mannequin = 0;    // node
  };

  Person AddPerson(const std::string& name, const motion::Clip& clip, const Look& look) {
    Person person;
    person.animation = retargeting::AnimateRig(skeleton_, clip);
    person.node = writer_.Add("nodes", {{"name", name}});
    person.first_joint = person.node + 1;
    AddJoints(person);
    const int skin = AddSkin(name, person);
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
                                {"translation", Array(person.animation.RestTranslation(j))}});
      const int parent =
          rig.joints[j].parent < 0 ? person.node : person.first_joint + rig.joints[j].parent;
      writer_.json()["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(node);
    }
  }

  // At rest no joint is turned, so that a bind matrix is a translation.
  int AddSkin(const std::string& name, const Person& person) {
    std::vector<Vec3d> to_joints;
    ordered_json joints = ordered_json::array();
    for (const Vec3d& position : person.animation.rest_positions) {
      joints.push_back(person.first_joint + static_cast<int>(to_joints.size()));
      to_joints.push_back(-position);
    }
    writer_.BeginView(GltfWriter::Use::kOther);
    const int matrices = writer_.AddTranslationMatrices(to_joints);
    return writer_.Add("skins", {{"name", name},
                                 {"inverseBindMatrices", matrices},
                                 {"skeleton", person.first_joint},
                                 {"joints", std::move(joints)}});
  }

  int AddMesh(const std::string& name, const RigAnimation& animation, const Look& look) {
    const retargeting::Mannequin mannequin =
        MakeMannequin(skeleton_, animation.rig, animation.rest_positions);
    const std::size_t joints = animation.rig.joints.size();
    ordered_json primitives = ordered_json::array();
    primitives.push_back(AddPrimitive(mannequin.body, joints, AddMaterial(name, look)));
    if (!mannequin.visor.indices.empty()) {
      if (visor_ < 0) visor_ = AddMaterial("visor", retargeting::kVisorLook);
      primitives.push_back(AddPrimitive(mannequin.visor, joints, visor_));
    }
    return writer_.Add("meshes", {{"name", absl::StrCat(name, "_mannequin")},
                                  {"primitives", std::move(primitives)}});
  }

  int AddMaterial(const std::string& name, const Look& look) {
    const retargeting::Colour colour = look.colour;
    return writer_.Add(
        "materials",
        {{"name", name},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {Linear(colour.red), Linear(colour.green), Linear(colour.blue), 1}},
           {"metallicFactor", 0},
           {"roughnessFactor", look.roughness}}}});
  }

  ordered_json AddPrimitive(const retargeting::SkinnedMesh& mesh, std::size_t joints,
                            int material) {
    const auto vertices = [this](auto add) {
      writer_.BeginView(GltfWriter::Use::kVertices);
      return add();
    };
    ordered_json attributes;
    attributes["POSITION"] = vertices([&] { return writer_.AddPositions(mesh.positions); });
    attributes["NORMAL"] = vertices([&] { return writer_.AddVectors(mesh.normals); });
    attributes["JOINTS_0"] = vertices([&] { return writer_.AddVertexJoints(mesh.joints, joints); });
    attributes["WEIGHTS_0"] = vertices([&] { return writer_.AddWholeWeights(mesh.joints.size()); });
    writer_.BeginView(GltfWriter::Use::kIndices);
    const int indices = writer_.AddIndices(mesh.indices, mesh.positions.size());
    return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", material}};
  }

  void AddAnimation(const motion::Clip& clip, const std::vector<Person>& people) {
    std::vector<float> seconds;
    for (int frame = 0; frame < clip.frame_count(); ++frame) {
      seconds.push_back(static_cast<float>(frame / clip.frame_rate_hz));
    }
    writer_.BeginView(GltfWriter::Use::kOther);
    times_ = writer_.AddTimes(seconds);
    for (const Person& person : people) AddTracks(person);
    writer_.Add("animations", std::move(animation_));
  }

  void AddTracks(const Person& person) {
    const RigAnimation& animation = person.animation;
    for (std::size_t j = 0; j < animation.rig.joints.size(); ++j) {
      const int node = person.first_joint + static_cast<int>(j);
      if (j == 0 || !animation.KeepsItsPlace(j)) {
        std::vector<Vec3d> translations;
        for (const RigPose& pose : animation.frames) translations.push_back(pose.translations[j]);
        AddTrack(node, "translation", writer_.AddVectors(translations));
      }
      if (j == 0 || !animation.NeverTurns(j)) {
        std::vector<Quaternion> rotations;
        for (const RigPose& pose : animation.frames) rotations.push_back(pose.rotations[j]);
        AddTrack(node, "rotation", writer_.AddRotations(rotations));
      }
    }
  }

  void AddTrack(int node, const char* path, int values) {
    animation_["channels"].push_back(
        {{"sampler", animation_["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation_["samplers"].push_back(
        {{"input", times_}, {"interpolation", "LINEAR"}, {"output", values}});
  }

  const motion::Skeleton& skeleton_;
  GltfWriter writer_;
  ordered_json animation_;
  int times_ = 0;   // accessor
  int visor_ = -1;  // material
};

}  // namespace

absl::StatusOr<std::string> FormatGltf(const std::vector<motion::Clip>& people,
                                       const motion::Skeleton& skeleton,
                                       const motion::Provenance* provenance,
                                       GltfContainer container) {
  absl::Status status = CheckPeople(people, skeleton);
  if (!status.ok()) return status;
  return GltfExporter(skeleton).Export(people, provenance, container);
}

}  // namespace duet::formats::gltf
