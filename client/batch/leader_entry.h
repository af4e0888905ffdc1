#ifndef DUET_CLIENT_BATCH_LEADER_ENTRY_H_
#define DUET_CLIENT_BATCH_LEADER_ENTRY_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/batch/recipe.h"
#include "model/motion/vec3.h"

namespace duet::client::batch {

// A leader that somebody listed, and what was said of it.
struct LeaderEntry {
  // Names its outputs: a path below the data set without an ending; no other entry has it.
  std::string key;
  std::string given;  // as it was listed
  std::string line;   // "MANIFEST:NUMBER", of a manifest; else empty
  std::filesystem::path file;
  std::optional<formats::Side> side;
  Labels labels;               // instead of the recipe's reactions where not empty
  std::string model;           // one of the recipe's; empty: all of them
  std::string follower_start;  // a point or a file; empty: as the recipe says
  std::optional<formats::Side> follower_start_side;
  std::optional<motion::Vec3> partner_direction;
  std::optional<uint64_t> seed;
  std::vector<std::pair<std::string, std::string>> extra;  // columns that are passed on, by name
};

// A path as a key: every part in UTF-8, without dots and without characters that file systems and
// archives reject, "walks/Kick 1.v2" as "walks/Kick_1_v2". Parts that lead upwards are left out.
std::string KeyOf(const std::filesystem::path& path);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_ENTRY_H_
