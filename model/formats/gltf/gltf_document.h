#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_DOCUMENT_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_DOCUMENT_H_

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::gltf {

// A node at rest: translation, rotation and scale, or a matrix instead.
struct GltfNode {
  std::string name;  // "node 3" if the file has none
  int parent = -1;
  int depth = 0;  // number of ancestors
  std::vector<int> children;
  retargeting::Vec3d translation;
  retargeting::Quaternion rotation;
  retargeting::Vec3d scale = {1, 1, 1};
  std::optional<std::array<double, 16>> matrix;  // column-major
};

struct GltfSkin {
  std::vector<int> joints;  // nodes
};

enum class GltfPath { kTranslation, kRotation, kScale };
enum class GltfInterpolation { kLinear, kStep, kCubicSpline };

// One property of one node over time.
struct GltfChannel {
  int node = 0;
  GltfPath path = GltfPath::kRotation;
  GltfInterpolation interpolation = GltfInterpolation::kLinear;
  int times = 0;   // accessor, seconds
  int values = 0;  // accessor
};

struct GltfAnimation {
  std::string name;                   // "animation 1" if the file has none
  std::vector<GltfChannel> channels;  // without morph targets
};

// The place of values in a buffer.
struct GltfAccessor {
  int view = -1;  // -1: none, all values are zero
  std::size_t offset = 0;
  int component_type = 0;  // a glTF constant
  bool normalized = false;
  std::size_t count = 0;
  int components = 1;
  bool sparse = false;  // some items are elsewhere; such values are not read
};
struct GltfView {
  int buffer = 0;
  std::size_t offset = 0;
  std::size_t length = 0;
  std::size_t stride = 0;  // 0: packed
};
struct GltfBuffer {
  std::string uri;  // empty: the binary chunk
  std::size_t length = 0;
};

// The skeletons of a glTF 2.0 file and their motion. Every index is valid and nodes form trees.
// Buffers have not been read.
struct GltfDocument {
  std::string writer;                   // the program that wrote it, if stated
  std::optional<double> frame_rate_hz;  // if Duet wrote it
  std::vector<GltfNode> nodes;
  std::vector<GltfSkin> skins;
  std::vector<GltfAnimation> animations;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfView> views;
  std::vector<GltfBuffer> buffers;
  std::optional<std::string> binary;  // the binary chunk of a .glb
};

// Parses a .gltf or a .glb; the first bytes select which.
// Errors: INVALID_ARGUMENT "source: nodes[3].rotation: expected ..., got ...".
absl::StatusOr<GltfDocument> ParseGltf(absl::string_view content, absl::string_view source);

// The JSON of a file that ParseGltf accepts.
absl::string_view JsonOf(absl::string_view content);

// Reads a file in the document's folder.
using GltfFileReader = std::function<absl::StatusOr<std::string>(const std::string& name)>;

// Reads the values of a document's accessors. Loads a buffer when it is first needed: the binary
// chunk, data within the document, or a file in the same folder (no other folder).
class GltfBuffers {
 public:
  // Both arguments must outlive this object.
  GltfBuffers(const GltfDocument& document, const GltfFileReader& read_file)
      : document_(document), read_file_(read_file) {}

  // Returns all values of an accessor. Integers are scaled to [-1, 1] as the format specifies.
  //
  // Shape: [count, components].
  // Errors: INVALID_ARGUMENT "accessors[3]: ..." for another kind of value, sparse ones, a range
  //         outside the buffer, a value that is not finite, or too many values in all; those of
  //         `read_file`.
  absl::StatusOr<std::vector<float>> Read(int accessor, int components);

  // Returns all bytes of a buffer; valid while this object lives. Errors: those of Read.
  absl::StatusOr<const std::string*> Whole(int buffer);

 private:
  absl::StatusOr<std::string> Load(const GltfBuffer& buffer) const;
  // The bytes of an accessor with a view: its items of `width` bytes, without those between them.
  // `name` is for errors.
  absl::StatusOr<std::string> ReadItems(const GltfAccessor& accessor, const std::string& name,
                                        std::size_t width);

  const GltfDocument& document_;
  const GltfFileReader& read_file_;
  std::map<int, std::string> loaded_;
  std::size_t bytes_loaded_ = 0, values_read_ = 0;
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_DOCUMENT_H_
