#ifndef DUET_MODEL_FORMATS_RESEARCH_NPZ_ARCHIVE_H_
#define DUET_MODEL_FORMATS_RESEARCH_NPZ_ARCHIVE_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::formats::research {

// NumPy's archive of named arrays: a zip file whose members are NPY files, stored or deflated. Only
// members that are read are decompressed. Refers to the parsed bytes.
//
// Source: PKZIP application note 6.3.3, without zip64, encryption or several disks.
class NpzArchive {
 public:
  // Reads the central directory.
  // Errors: INVALID_ARGUMENT naming `source`.
  static absl::StatusOr<NpzArchive> Parse(absl::string_view bytes, absl::string_view source);

  // The arrays' names, without ".npy", in alphabetical order.
  std::vector<std::string> Names() const;
  bool Has(absl::string_view name) const { return members_.count(std::string(name)) > 0; }

  // The NPY file of an array. A member has at most motion::kMaxMotionFileBytes, whatever it states.
  // Errors: INVALID_ARGUMENT naming `source`, the array and the arrays that there are, if it is
  //         missing or damaged.
  absl::StatusOr<std::string> Read(absl::string_view name) const;

  const std::string& source() const { return source_; }

 private:
  struct Member {
    std::uint32_t method = 0, crc = 0, packed_bytes = 0, bytes = 0, at = 0;
  };
  absl::Status Error(absl::string_view message) const;
  absl::StatusOr<absl::string_view> Packed(const std::string& name, const Member& member) const;

  std::string source_;
  absl::string_view bytes_;
  std::map<std::string, Member> members_;
};

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_NPZ_ARCHIVE_H_
