#ifndef DUET_CONTRIB_FORMATS_TESTS_FBX_FBX_FIXTURE_H_
#define DUET_CONTRIB_FORMATS_TESTS_FBX_FBX_FIXTURE_H_

#include <string>

#include "absl/status/statusor.h"
#include "contrib/formats/fbx/fbx_conversion.h"
#include "model/formats/motion_file.h"

namespace duet::test {

// Reads FBX as a user does: converted to glTF first.
inline absl::StatusOr<motion::Clip> FromFbx(const std::string& content,
                                            formats::ReadOptions options = {}) {
  const absl::StatusOr<std::string> glb = contrib::formats::fbx::ConvertFbx(content);
  if (!glb.ok()) return glb.status();
  options.format = formats::Format::kGlb;
  return formats::ParseLeader(*glb, "a.glb", options);
}

}  // namespace duet::test

#endif  // DUET_CONTRIB_FORMATS_TESTS_FBX_FBX_FIXTURE_H_
