#ifndef DUET_CLIENT_BATCH_MANIFEST_H_
#define DUET_CLIENT_BATCH_MANIFEST_H_

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>

#include "client/batch/leader_source.h"

namespace duet::client::batch {

// Reads a manifest line by line: JSON objects if the first line begins with '{', otherwise TSV
// (ManifestLine in proto/duet/batch/v1/batch.proto). Relative paths begin at `folder`; errors call
// the manifest `name`. `in` outlives the source.
std::unique_ptr<LeaderSource> ReadManifest(std::istream& in, const std::filesystem::path& folder,
                                           const std::string& name);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_MANIFEST_H_
