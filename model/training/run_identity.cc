#include "model/training/run_identity.h"

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"

namespace duet::training {
namespace {

constexpr size_t kDescribed = 5;

struct Parts {
  absl::string_view manifest;
  std::map<absl::string_view, absl::string_view> settings;
  absl::string_view sequences;
};

// Settings are the lines before the last one that have the form name=value. The manifest is JSON,
// whose lines begin with a brace or a space.
Parts Parse(absl::string_view identity) {
  Parts parts;
  const size_t last = identity.rfind('\n');
  parts.sequences = last == absl::string_view::npos ? "" : identity.substr(last + 1);
  size_t manifest_end = 0, at = 0;
  for (absl::string_view line : absl::StrSplit(identity.substr(0, last), '\n')) {
    const size_t equals = line.find('=');
    at += line.size() + 1;
    if (line.empty() || line[0] == ' ' || line[0] == '{' || line[0] == '}') {
      manifest_end = at;
    } else if (equals != absl::string_view::npos) {
      parts.settings[line.substr(0, equals)] = line.substr(equals + 1);
    }
  }
  parts.manifest = identity.substr(0, manifest_end);
  return parts;
}

}  // namespace

std::string RunIdentity(const std::string& manifest,
                        const std::map<std::string, std::string>& settings,
                        const std::string& sequences) {
  return absl::StrCat(manifest, absl::StrJoin(settings, "\n", absl::PairFormatter("=")), "\n",
                      sequences);
}

std::string DescribeIdentityChange(absl::string_view saved, absl::string_view now) {
  const Parts before = Parse(saved), after = Parse(now);
  std::set<absl::string_view> names;
  for (const Parts* parts : {&before, &after}) {
    for (const auto& [name, value] : parts->settings) names.insert(name);
  }
  const auto shown = [](const Parts& parts, absl::string_view name) {
    const auto found = parts.settings.find(name);
    return found == parts.settings.end() ? absl::string_view("none") : found->second;
  };
  std::vector<std::string> changes;
  for (const absl::string_view name : names) {
    const absl::string_view was = shown(before, name), is = shown(after, name);
    if (was != is) changes.push_back(absl::StrCat(name, ": expected ", was, ", got ", is));
  }
  if (changes.size() > kDescribed) {
    const size_t more = changes.size() - kDescribed;
    changes.resize(kDescribed);
    changes.push_back(absl::StrCat("and ", more, " more"));
  }
  if (!changes.empty()) return absl::StrJoin(changes, "; ");
  return before.sequences != after.sequences ? "the data: expected the same sequences, got others"
                                             : "the model: expected the same, got another name, "
                                               "version, description or data";
}

}  // namespace duet::training
