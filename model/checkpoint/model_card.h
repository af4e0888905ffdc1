#ifndef DUET_MODEL_CHECKPOINT_MODEL_CARD_H_
#define DUET_MODEL_CHECKPOINT_MODEL_CARD_H_

#include <string>

#include "model/checkpoint/manifest.h"

namespace duet::checkpoint {

// A description of the model for people, beside the manifest. No program reads it.
inline constexpr char kModelCardFile[] = "MODEL_CARD.md";

// A model card in Markdown: the content of the manifest, the intended use, the limits, and the
// terms of the training data as a sentence to complete. Requires a manifest that ParseManifest
// accepts.
std::string ModelCard(const Manifest& manifest);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_MODEL_CARD_H_
