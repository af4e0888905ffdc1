#ifndef DUET_TESTS_CHECKPOINT_EDITED_MANIFEST_H_
#define DUET_TESTS_CHECKPOINT_EDITED_MANIFEST_H_

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "model/checkpoint/manifest.h"
#include "tests/support/status_matchers.h"

namespace duet::checkpoint {

// Matches INVALID_ARGUMENT with these words.
inline auto IsInvalid(const std::string& words) {
  return test::StatusIs(absl::StatusCode::kInvalidArgument, ::testing::HasSubstr(words));
}

// Parses the text of a manifest in which the value at a JSON pointer is replaced.
inline absl::Status ParseEdited(const Manifest& manifest, const std::string& pointer,
                                const nlohmann::json& value) {
  nlohmann::json root = nlohmann::json::parse(SerializeManifest(manifest));
  root[nlohmann::json::json_pointer(pointer)] = value;
  return ParseManifest(root.dump()).status();
}

}  // namespace duet::checkpoint

#endif  // DUET_TESTS_CHECKPOINT_EDITED_MANIFEST_H_
