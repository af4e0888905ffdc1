#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_COMPACTION_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_COMPACTION_H_

#include <string>

#include "nlohmann/json.hpp"

namespace duet::formats::gltf {

// Removes the animations of a document with one buffer, and the accessors, views and bytes that
// only they used. If an extension may refer to accessors, or an index or range is invalid, removes
// only the animations.
void DropAnimations(nlohmann::ordered_json* json, std::string* buffer);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_COMPACTION_H_
