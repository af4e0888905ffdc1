#include "client/batch/shard_offsets.h"

#include "client/batch/archive.h"
#include "client/batch/record.h"

namespace duet::client::batch {

std::string MemberName(Packing packing, const std::string& path) {
  return packing == Packing::kTar ? NameInTar(path) : path;
}

uint64_t ShardOffsets::Next(size_t shard, const nlohmann::ordered_json& record, size_t file) {
  uint64_t& end = ends_[shard];
  uint64_t found = 0;
  for (size_t i = 0; i < record["files"].size(); ++i) {
    const std::string name = MemberName(packing_, record["files"][i]["path"]);
    const uint64_t begin = end + MemberHeaderBytes(packing_, name);
    if (i == file) found = begin;
    end = begin + MemberContentBytes(packing_, record["files"][i]["bytes"].get<uint64_t>());
  }
  // An npz shard has its records at its end.
  if (packing_ == Packing::kTar) {
    const std::string name = RecordNameInTar(record["name"]);
    end +=
        MemberHeaderBytes(packing_, name) + MemberContentBytes(packing_, Line(record).size() + 1);
  }
  return found;
}

}  // namespace duet::client::batch
