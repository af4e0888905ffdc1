#ifndef DUET_MODEL_RETARGETING_MESH_BUILDER_H_
#define DUET_MODEL_RETARGETING_MESH_BUILDER_H_

#include <cstdint>
#include <vector>

#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// A surface of triangles; every vertex follows one joint of a rig.
struct SkinnedMesh {
  std::vector<Vec3d> positions;   // [vertices], metres, of the rest pose
  std::vector<Vec3d> normals;     // [vertices], of length 1, outwards
  std::vector<int> joints;        // [vertices], rig joints
  std::vector<uint32_t> indices;  // three per triangle, counterclockwise from outside
};

// The number of divisions of an ellipsoid: around, and from pole to pole.
struct Fineness {
  int around = 10, stacks = 6;
};

// Adds surfaces of revolution to a mesh. Units: metres.
class MeshBuilder {
 public:
  // `mesh` must outlive the builder.
  explicit MeshBuilder(SkinnedMesh* mesh) : mesh_(*mesh) {}

  // Adds an ellipsoid with half axes along x, y and z.
  void AddEllipsoid(Vec3d centre, Vec3d half, int joint, Fineness fineness);
  // Adds an open, tapered tube.
  void AddLimb(Vec3d from, Vec3d to, double radius_from, double radius_to, int joint);

 private:
  uint32_t Count() const { return static_cast<uint32_t>(mesh_.positions.size()); }
  void AddVertex(Vec3d position, Vec3d normal, int joint);
  void AddTriangle(uint32_t a, uint32_t b, uint32_t c);
  // Adds the triangles between the ring that begins at vertex `ring` and the next one.
  void AddBand(uint32_t ring, uint32_t around);

  SkinnedMesh& mesh_;
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_MESH_BUILDER_H_
