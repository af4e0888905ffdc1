#ifndef DUET_MODEL_CHECKPOINT_MODEL_CARD_H_
#define DUET_MODEL_CHECKPOINT_MODEL_CARD_H_

#include <string>

#include "model/checkpoint/manifest.h"

namespace duet::checkpoint {

// The file beside the manifest that tells people what the model is. No program reads it.
inline constexpr char kModelCardFile[] = "MODEL_CARD.md";

// A model card in Markdown: what the manifest says in the words of a reader, what the model is
// meant for, its limits, and the terms of its data as a sentence to complete.
// Requires a manifest that ParseManifest accepts.
std::string ModelCard(const Manifest& manifest);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_MODEL_CARD_H_
