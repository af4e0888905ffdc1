#ifndef DUET_CLIENT_BATCH_MANIFEST_H_
#define DUET_CLIENT_BATCH_MANIFEST_H_

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>

#include "client/batch/leader_source.h"

namespace duet::client::batch {

// A manifest, line by line: JSON objects where the first line begins with '{', else TSV
// (ManifestLine in proto/duet/batch/v1/batch.proto). `folder` is where relative paths begin, `name`
// is how errors call the manifest. `in` outlives the source.
std::unique_ptr<LeaderSource> ReadManifest(std::istream& in, const std::filesystem::path& folder,
                                           const std::string& name);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_MANIFEST_H_
