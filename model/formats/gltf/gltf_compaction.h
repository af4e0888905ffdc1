#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_COMPACTION_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_COMPACTION_H_

#include <string>

#include "nlohmann/json.hpp"

namespace duet::formats::gltf {

// Removes the animations of a document with one buffer, and the accessors, views and bytes that
// only they used. A document with an extension that may refer to accessors in its own way keeps all
// but the animations, and so does one whose indices or ranges are invalid.
void DropAnimations(nlohmann::ordered_json* json, std::string* buffer);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_COMPACTION_H_
