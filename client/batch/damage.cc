#include "client/batch/damage.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <system_error>

#include "client/batch/durable_file.h"
#include "model/base/file.h"

namespace duet::client::batch {
namespace {

constexpr size_t kMaxDamageBytes = size_t{1} << 30;  // ten digits for each of kMaxItems

}  // namespace

Damage ReadDamage(const std::filesystem::path& file) {
  Damage damage;
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxDamageBytes, "damage");
  if (!text.ok()) return damage;
  const auto object = nlohmann::json::parse(*text, nullptr, false);
  if (!object.is_object()) return damage;
  for (const auto& item : object.value("items", nlohmann::json::array())) {
    if (item.is_number_unsigned()) damage.items.insert(item.get<int64_t>());
  }
  for (const auto& shard : object.value("shards", nlohmann::json::array())) {
    if (shard.is_string()) damage.shards.insert(shard.get<std::string>());
  }
  return damage;
}

absl::Status WriteDamage(const Damage& damage, const std::filesystem::path& file) {
  if (!damage.empty()) {
    const nlohmann::ordered_json object = {{"items", damage.items}, {"shards", damage.shards}};
    return ReplaceDurably(file, object.dump() + "\n");
  }
  std::error_code error;
  if (!std::filesystem::remove(file, error)) {
    return error ? CannotWrite(file, error.value()) : absl::OkStatus();
  }
  return SyncFolder(file.parent_path());
}

}  // namespace duet::client::batch
