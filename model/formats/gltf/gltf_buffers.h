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

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_BUFFERS_H_
