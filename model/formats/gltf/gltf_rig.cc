#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/index.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/formats/gltf/gltf_motion.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/character.h"

namespace duet::formats::gltf {
namespace {

using nlohmann::ordered_json;
using retargeting::CharacterPose;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kNoTurn = 1e-6;  // radians
constexpr std::size_t kAlignment = 4;

using base::Index;

// A node at rest, in its parent's axes or the world's. `scale` is the mean over the axes.
struct Place {
  Vec3d at;
  Quaternion turn;
  double scale = 1;

  Place operator*(const Place& inner) const {
    return {at + Rotate(turn, inner.at * scale), turn * inner.turn, scale * inner.scale};
  }
};

Place LocalPlace(const GltfNode& node) {
  if (!node.matrix.has_value()) {
    const Vec3d s = node.scale;
    return {node.translation, Normalised(node.rotation), (s.x + s.y + s.z) / 3};
  }
  const auto& m = *node.matrix;
  const Vec3d x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
  return {{m[12], m[13], m[14]},
          retargeting::FromAxes(Unit(x, {1, 0, 0}), Unit(y, {0, 1, 0}), Unit(z, {0, 0, 1})),
          (Norm(x) + Norm(y) + Norm(z)) / 3};
}

class RigAnimator {
 public:
  RigAnimator(const GltfDocument& document, std::vector<int> nodes,
              const retargeting::CharacterFit& fit)
      : document_(document),
        nodes_(std::move(nodes)),
        fit_(fit),
        to_world_(retargeting::ToWorldAxes(fit.up_axis)) {
    std::vector<int> place_of(document.nodes.size(), -1);
    for (std::size_t j = 0; j < nodes_.size(); ++j)
      place_of[Index(nodes_[j])] = static_cast<int>(j);
    for (int node : nodes_) {
      const int parent = document.nodes[Index(node)].parent;
      parents_.push_back(parent < 0 ? -1 : place_of[Index(parent)]);
      const Place above = parents_.back() < 0 ? RestAbove(parent) : rest_[Index(parents_.back())];
      rest_.push_back(above * LocalPlace(document.nodes[Index(node)]));
    }
  }

  retargeting::CharacterRig Rig() const {
    retargeting::CharacterRig rig;
    rig.joints = fit_.joints;
    rig.parents = parents_;
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      rig.names.push_back(document_.nodes[Index(nodes_[j])].name);
      rig.positions.push_back(Rotate(to_world_, rest_[j].at) * fit_.metres_per_unit);
      rig.moves.push_back(true);
    }
    return rig;
  }

  // Adds the animation and prepares the nodes that it moves.
  void Write(const std::vector<CharacterPose>& poses, double frame_rate_hz, GltfWriter* writer) {
    AnimationWriter animation("duet", poses.size(), frame_rate_hz, writer);
    for (std::size_t j = 0; j < nodes_.size(); ++j) AddJoint(j, poses, writer, &animation);
    writer->json()["animations"] = ordered_json::array({animation.Take()});
  }

 private:
  Place RestAbove(int node) const {
    if (node < 0) return {};
    const GltfNode& written = document_.nodes[Index(node)];
    return RestAbove(written.parent) * LocalPlace(written);
  }

  // A joint in the file's world axes in this pose.
  Place Posed(const CharacterPose& pose, std::size_t j) const {
    const Quaternion turn = Inverse(to_world_) * pose.turns[j] * to_world_;
    return {Rotate(Inverse(to_world_), pose.positions[j]) * (1 / fit_.metres_per_unit),
            turn * rest_[j].turn, rest_[j].scale};
  }

  Place PosedAbove(const CharacterPose& pose, std::size_t j) const {
    if (parents_[j] >= 0) return Posed(pose, Index(parents_[j]));
    return RestAbove(document_.nodes[Index(nodes_[j])].parent);
  }

  void AddJoint(std::size_t j, const std::vector<CharacterPose>& poses, GltfWriter* writer,
                AnimationWriter* animation) const {
    const Place written = LocalPlace(document_.nodes[Index(nodes_[j])]);
    std::vector<Quaternion> turns;
    std::vector<Vec3d> places;
    bool turned = false, moved = false;
    for (const CharacterPose& pose : poses) {
      const Place above = PosedAbove(pose, j), here = Posed(pose, j);
      Quaternion turn = Normalised(Inverse(above.turn) * here.turn);
      if (!turns.empty() && Dot(turn, turns.back()) < 0)
        turn = {-turn.w, -turn.x, -turn.y, -turn.z};
      turns.push_back(turn);
      places.push_back(Rotate(Inverse(above.turn), here.at - above.at) * (1 / above.scale));
      turned = turned || Angle(turn, written.turn) > kNoTurn;
      moved = moved || Norm(places.back() - written.at) > 1e-5 * (1 + Norm(written.at));
    }
    if (!turned && !moved) return;
    MakeMovable(nodes_[j], written, writer);
    if (moved) animation->Translate(nodes_[j], places);
    if (turned) animation->Rotate(nodes_[j], turns);
  }

  // Replaces the matrix of a node: an animated node must not have one.
  void MakeMovable(int node, const Place& rest, GltfWriter* writer) const {
    ordered_json& written = writer->json()["nodes"][Index(node)];
    if (!written.contains("matrix")) return;
    written.erase("matrix");
    written["translation"] = {rest.at.x, rest.at.y, rest.at.z};
    written["rotation"] = {rest.turn.x, rest.turn.y, rest.turn.z, rest.turn.w};
    written["scale"] = {rest.scale, rest.scale, rest.scale};
  }

  const GltfDocument& document_;
  std::vector<int> nodes_;    // [joints]
  std::vector<int> parents_;  // [joints]
  std::vector<Place> rest_;   // [joints], in the file's world
  retargeting::CharacterFit fit_;
  Quaternion to_world_;
};

// The document without its animations, with all of its buffers as one.
absl::StatusOr<GltfWriter> Gather(absl::string_view content, const GltfDocument& document,
                                  GltfBuffers* buffers) {
  ordered_json json = ordered_json::parse(JsonOf(content), nullptr, false);
  std::string all;
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < document.buffers.size(); ++i) {
    const absl::StatusOr<const std::string*> bytes = buffers->Whole(static_cast<int>(i));
    if (!bytes.ok()) return bytes.status();
    begins.push_back(all.size());
    all.append(**bytes);
    all.resize((all.size() + kAlignment - 1) / kAlignment * kAlignment, '\0');
  }
  for (std::size_t i = 0; i < document.views.size(); ++i) {
    ordered_json& view = json["bufferViews"][i];
    view["byteOffset"] = document.views[i].offset + begins[Index(document.views[i].buffer)];
    view["buffer"] = 0;
  }
  json.erase("animations");
  return GltfWriter(std::move(json), std::move(all));
}

// The nodes at rest must be a standing person; `read` is the motion of the rig.
absl::Status CheckRest(const retargeting::CharacterRig& rig, const motion::Clip& read,
                       absl::string_view source) {
  const absl::StatusOr<std::optional<int>> frame = retargeting::FindRestFrame(rig, read, source);
  if (!frame.ok() || !frame->has_value()) return frame.status();
  return absl::InvalidArgumentError(
      absl::StrCat(source,
                   ": rig: rest pose: expected a standing person, got nodes that make one only in "
                   "their animation; export the rig in its T pose"));
}

}  // namespace

absl::StatusOr<std::string> OntoGltfRig(const motion::Clip& clip, absl::string_view content,
                                        absl::string_view source, const GltfFileReader& read_file,
                                        const GltfImportOptions& options, GltfContainer container) {
  const absl::StatusOr<GltfDocument> document = ParseGltf(content, source);
  if (!document.ok()) return document.status();
  std::vector<int> nodes;
  retargeting::CharacterFit fit;
  GltfImportOptions reading = options;
  reading.fit = &fit;
  reading.nodes = &nodes;
  const absl::StatusOr<motion::Clip> read = FromGltf(*document, source, read_file, reading);
  if (!read.ok()) return read.status();
  RigAnimator animator(*document, nodes, fit);
  absl::Status status = CheckRest(animator.Rig(), *read, source);
  if (!status.ok()) return status;
  const absl::StatusOr<std::vector<CharacterPose>> poses =
      TransferToRig(clip, animator.Rig(), source);
  if (!poses.ok()) return poses.status();
  GltfBuffers buffers(*document, read_file);
  absl::StatusOr<GltfWriter> writer = Gather(content, *document, &buffers);
  if (!writer.ok()) return writer.status();
  animator.Write(*poses, clip.frame_rate_hz, &*writer);
  return container == GltfContainer::kBinary ? writer->Binary() : writer->Text();
}

}  // namespace duet::formats::gltf
