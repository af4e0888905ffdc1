#ifndef DUET_MODEL_CLASSIFIER_CLASSIFIER_FILES_H_
#define DUET_MODEL_CLASSIFIER_CLASSIFIER_FILES_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/classifier/classifier.h"

namespace duet::classifier {

// A classifier in a folder, data only:
//   judge.json           {"format": 1, "classes", "skeleton", "frame_rate_hz", "window_frames",
//                         "hidden", "networks", "weights_sha256"}
//   weights.safetensors  the tensors
//
// Errors: NOT_FOUND; INVALID_ARGUMENT and DATA_LOSS naming the file, the field, its value and what
//         was expected. The files may be untrusted.

struct StoredClassifier {
  Classifier classifier;
  std::string sha256;  // of judge.json, which contains that of the weights
};
absl::StatusOr<StoredClassifier> ReadClassifier(const std::filesystem::path& folder);

// Parses the contents of the two files.
absl::StatusOr<StoredClassifier> ParseClassifier(const std::string& json,
                                                 const std::string& weights);

// Creates the folder.
absl::Status WriteClassifier(const std::filesystem::path& folder, const ClassifierParts& parts);

}  // namespace duet::classifier

#endif  // DUET_MODEL_CLASSIFIER_CLASSIFIER_FILES_H_
