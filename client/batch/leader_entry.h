#ifndef DUET_CLIENT_BATCH_LEADER_ENTRY_H_
#define DUET_CLIENT_BATCH_LEADER_ENTRY_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/batch/pins.h"
#include "client/batch/recipe.h"
#include "model/motion/vec3.h"

namespace duet::client::batch {

// A leader of the list, with its settings.
struct LeaderEntry {
  // Unique name of its outputs: a path relative to the data set, without extension.
  std::string key;
  bool has_id = false;  // the key is the `id` of a manifest
  std::string given;    // as listed
  std::string line;     // "MANIFEST:NUMBER" if it comes from a manifest
  std::filesystem::path file;
  std::optional<formats::Side> side;
  Labels labels;               // if not empty, override the recipe's reactions
  std::string model;           // one of the recipe's; empty: all of them
  std::string follower_start;  // a point or a file; empty: set by the recipe
  std::optional<formats::Side> follower_start_side;
  std::optional<motion::Vec3> partner_direction;
  std::string group;  // whose leaders are all in one split; empty: none
  Pins pins;
  std::optional<uint64_t> seed;
  std::vector<std::pair<std::string, std::string>> extra;  // other columns, by name
};

// A path as a key: every part in UTF-8, without dots and without characters that file systems and
// archives reject, "walks/Kick 1.v2" as "walks/Kick_1_v2". Drops parent folders ("..").
std::string KeyOf(const std::filesystem::path& path);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_ENTRY_H_
