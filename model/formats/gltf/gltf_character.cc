#include "model/formats/gltf/gltf_character.h"

#include <cstddef>
#include <utility>

#include "model/base/index.h"
#include "model/formats/gltf/gltf_parts.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/retargeting/mannequin.h"
#include "model/retargeting/mannequin_look.h"
#include "model/retargeting/rest_rig.h"

namespace duet::formats::gltf {
namespace {

using nlohmann::ordered_json;
using retargeting::CharacterRig;
using retargeting::LocalPose;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr char kName[] = "follower";

using base::Index;

// Adds a parent node, then the joints in the rig's order below it. Returns the parent.
int AddJoints(const CharacterRig& rig, GltfWriter* writer) {
  const int holder = writer->Add("nodes", {{"name", kName}});
  for (std::size_t j = 0; j < rig.names.size(); ++j) {
    const int parent = rig.parents[j];
    const Vec3d offset = rig.positions[j] - (parent < 0 ? Vec3d{} : rig.positions[Index(parent)]);
    const int node =
        writer->Add("nodes", {{"name", rig.names[j]}, {"translation", ToArray(offset)}});
    const int above = parent < 0 ? holder : holder + 1 + parent;
    writer->json()["nodes"][Index(above)]["children"].push_back(node);
  }
  return holder;
}

int AddBody(const CharacterRig& rig, int first_joint, GltfWriter* writer) {
  const int skin = AddSkin(kName, first_joint, rig.positions, writer);
  const int material = AddMaterial(kName, retargeting::kFollowerLook, writer);
  ordered_json primitives = ordered_json::array(
      {AddPrimitive(retargeting::MakeStickFigure(rig), rig.names.size(), material, writer)});
  const int mesh = writer->Add("meshes", {{"name", kName}, {"primitives", std::move(primitives)}});
  return writer->Add("nodes", {{"name", "follower_body"}, {"mesh", mesh}, {"skin", skin}});
}

// Chooses between q and -q so that players interpolate along the shorter arc.
std::vector<Quaternion> TurnsOf(const std::vector<LocalPose>& poses, std::size_t joint) {
  std::vector<Quaternion> turns;
  for (const LocalPose& pose : poses) {
    Quaternion turn = pose.turns[joint];
    if (!turns.empty() && Dot(turn, turns.back()) < 0) turn = {-turn.w, -turn.x, -turn.y, -turn.z};
    turns.push_back(turn);
  }
  return turns;
}

std::vector<Vec3d> PlacesOf(const std::vector<LocalPose>& poses, std::size_t joint) {
  std::vector<Vec3d> places;
  for (const LocalPose& pose : poses) places.push_back(pose.places[joint]);
  return places;
}

}  // namespace

std::string FormatCharacter(const CharacterRig& rig,
                            const std::vector<retargeting::CharacterPose>& poses,
                            double frame_rate_hz, const motion::Provenance* provenance,
                            GltfContainer container) {
  GltfWriter writer;
  const int holder = AddJoints(rig, &writer);
  const int body = AddBody(rig, holder + 1, &writer);
  std::vector<LocalPose> local;
  for (const retargeting::CharacterPose& pose : poses) local.push_back(ToLocal(rig, pose));
  AnimationWriter animation("duet", poses.size(), frame_rate_hz, &writer);
  for (std::size_t j = 0; j < rig.names.size(); ++j) {
    const int node = holder + 1 + static_cast<int>(j);
    if (rig.moves[j]) animation.Translate(node, PlacesOf(local, j));
    animation.Rotate(node, TurnsOf(local, j));
  }
  writer.Add("animations", animation.Take());
  writer.json()["asset"]["extras"] = {{"frame_rate_hz", frame_rate_hz}};
  ordered_json scene = {{"name", kName}, {"nodes", {holder, body}}};
  if (provenance != nullptr) scene["extras"] = Extras(*provenance);
  writer.json()["scene"] = 0;
  writer.Add("scenes", std::move(scene));
  return container == GltfContainer::kBinary ? writer.Binary() : writer.Text();
}

}  // namespace duet::formats::gltf
