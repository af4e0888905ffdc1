#include "client/batch/recipe_difference.h"

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/strict_json.h"

namespace duet::client::batch {
namespace {

using nlohmann::json;

constexpr size_t kDescribed = 5;

// All values except objects and arrays, by path: "reactions[0].labels.weights.kick".
using Fields = std::map<std::string, json>;

void Flatten(const json& value, const std::string& path, Fields* fields) {
  if (value.is_object() && !value.empty()) {
    for (const auto& [name, member] : value.items()) {
      Flatten(member, path.empty() ? name : absl::StrCat(path, ".", name), fields);
    }
  } else if (value.is_array() && !value.empty()) {
    for (size_t i = 0; i < value.size(); ++i) {
      Flatten(value[i], absl::StrCat(path, "[", i, "]"), fields);
    }
  } else if (!path.empty()) {
    (*fields)[path] = value;
  }
}

std::string ShownAt(const Fields& fields, const std::string& path) {
  const auto found = fields.find(path);
  return found == fields.end() ? "none" : base::Shown(found->second);
}

}  // namespace

std::string DescribeDifference(const std::string& expected, const std::string& got) {
  const json before = json::parse(expected, nullptr, false), now = json::parse(got, nullptr, false);
  if (!before.is_object() || !now.is_object()) return "";
  Fields old_fields, new_fields;
  Flatten(before, "", &old_fields);
  Flatten(now, "", &new_fields);
  std::set<std::string> paths;
  for (const auto& [path, value] : old_fields) paths.insert(path);
  for (const auto& [path, value] : new_fields) paths.insert(path);
  std::vector<std::string> described;
  size_t differing = 0;
  for (const std::string& path : paths) {
    const std::string was = ShownAt(old_fields, path), is = ShownAt(new_fields, path);
    if (was == is || ++differing > kDescribed) continue;
    described.push_back(absl::StrCat(path, ": expected ", was, ", got ", is));
  }
  if (differing > kDescribed) {
    described.push_back(absl::StrCat("and ", differing - kDescribed, " more"));
  }
  return absl::StrJoin(described, "; ");
}

}  // namespace duet::client::batch
