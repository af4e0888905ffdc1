#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_BUFFERS_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_BUFFERS_H_

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/gltf/gltf_document.h"

namespace duet::formats::gltf {

// Reads a file beside the document, by its name.
using GltfFileReader = std::function<absl::StatusOr<std::string>(const std::string& name)>;

// The numbers behind a document's accessors. A buffer is read when it is first needed: the binary
// chunk, data within the document, or a file in the same folder (never one above or elsewhere).
class GltfBuffers {
 public:
  // Both outlive the buffers.
  GltfBuffers(const GltfDocument& document, const GltfFileReader& read_file)
      : document_(document), read_file_(read_file) {}

  // All values of an accessor with `components` a value, whole numbers scaled to [-1, 1] as the
  // format has it. [count, components]
  //
  // Errors: INVALID_ARGUMENT "accessors[3]: ..." for another kind of value, a place outside its
  //         buffer, a value that is not finite, or more values altogether than a motion may have;
  //         what `read_file` says.
  absl::StatusOr<std::vector<float>> Read(int accessor, int components);

  // All bytes of a buffer. Lives as long as this. Errors as of Read.
  absl::StatusOr<const std::string*> Whole(int buffer);

 private:
  absl::StatusOr<std::string> Load(const GltfBuffer& buffer) const;

  const GltfDocument& document_;
  const GltfFileReader& read_file_;
  std::map<int, std::string> loaded_;
  std::size_t bytes_loaded_ = 0, values_read_ = 0;
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_BUFFERS_H_
