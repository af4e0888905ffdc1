#ifndef DUET_MODEL_TRAINING_RUN_IDENTITY_H_
#define DUET_MODEL_TRAINING_RUN_IDENTITY_H_

#include <map>
#include <string>

#include "absl/strings/string_view.h"

namespace duet::training {

// What a saved state is valid for, as a text: the manifest that the run begins with, every setting,
// and the sequences.
std::string RunIdentity(const std::string& manifest,
                        const std::map<std::string, std::string>& settings,
                        const std::string& sequences);

// How the run of an identity differs from that of a saved state, as "epochs: expected 300, got
// 200": the first settings, and the number of others; without them "the data" or "the model".
std::string DescribeIdentityChange(absl::string_view saved, absl::string_view now);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_RUN_IDENTITY_H_
