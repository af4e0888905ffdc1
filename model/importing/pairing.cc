#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/dataset/table.h"
#include "model/importing/steps.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;

// The last words of two names that denote two people.
struct RoleWords {
  const char* first;
  const char* second;
  bool tells_leader;
};
constexpr RoleWords kRoleWords[] = {{"leader", "follower", true}, {"a", "b", false},
                                    {"p1", "p2", false},          {"person1", "person2", false},
                                    {"actor1", "actor2", false},  {"first", "second", false},
                                    {"left", "right", false}};

bool IsSeparator(char c) { return c == '_' || c == '-' || c == '.' || c == ' '; }
bool IsDigit(char c) { return absl::ascii_isdigit(static_cast<unsigned char>(c)); }

// A file name taken apart: "kick/day 1/02_a.bvh".
struct Parsed {
  std::string file;
  std::vector<std::string> words;   // kick, day 1, 02; without a name that is only the role
  const RoleWords* role = nullptr;  // the words it ends with, if any
  bool second = false;              // whether it ends with the second word
};

Parsed ParseName(const std::string& file) {
  Parsed parsed;
  parsed.file = file;
  const fs::path path(file);
  for (const fs::path& folder : path.parent_path()) parsed.words.push_back(folder.string());
  const std::string name = path.stem().string(), stem = absl::AsciiStrToLower(name);
  for (const RoleWords& role : kRoleWords) {
    for (const bool second : {false, true}) {
      const std::string word = second ? role.second : role.first;
      if (!absl::EndsWith(stem, word)) continue;
      const std::size_t rest = stem.size() - word.size();
      if (rest > 0 && !IsSeparator(stem[rest - 1])) continue;
      if (rest > 1) parsed.words.push_back(name.substr(0, rest - 1));
      parsed.role = &role;
      parsed.second = second;
      return parsed;
    }
  }
  if (!name.empty()) parsed.words.push_back(name);
  return parsed;
}

// "kick_01" -> "kick". A name that is only a number is unchanged.
std::string WithoutNumber(const std::string& name) {
  std::size_t end = name.size();
  while (end > 0 && (IsDigit(name[end - 1]) || IsSeparator(name[end - 1]))) --end;
  return end == 0 || end == name.size() || !IsDigit(name.back()) ? name : name.substr(0, end);
}

// Converts text to a file name that is valid on every system.
std::string ToFileName(absl::string_view text) {
  std::string name(text);
  for (char& c : name) {
    const bool plain = absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.';
    if (!plain) c = '_';
  }
  return std::string(absl::StripPrefix(name, "."));
}

// Sets the label and the name of a file's pair.
void NamePair(const Parsed& parsed, PairFiles* pair) {
  std::vector<std::string> words = parsed.words;
  const bool in_class_folder = words.size() > 1;
  if (words.empty()) return;
  pair->label = ToLabel(in_class_folder ? words.front() : WithoutNumber(words.front()));
  if (in_class_folder) words.erase(words.begin());
  pair->name = ToFileName(absl::StrJoin(words, "_"));
}

// Appends numbers to equal names.
void MakeNamesUnique(std::vector<PairFiles>* pairs) {
  std::set<std::string> seen;
  for (PairFiles& pair : *pairs) {
    const std::string name = pair.name;
    for (int number = 2; !seen.insert(absl::StrCat(pair.label, "/", pair.name)).second; ++number) {
      pair.name = absl::StrCat(name, "_", number);
    }
  }
}

void Add(PairFiles pair, Pairing* pairing) {
  if (pair.label.empty()) {
    pairing->refused.push_back(
        {pair.first,
         "class: expected a name CLASS_NUMBER or a folder for each class, got neither; rename the "
         "file or write a table"});
    return;
  }
  pairing->pairs.push_back(std::move(pair));
}

// Adds the files with one name and one pair of words.
void AddGroup(const std::vector<Parsed>& group, Pairing* pairing) {
  std::vector<const Parsed*> people[2];
  for (const Parsed& one : group) people[one.second ? 1 : 0].push_back(&one);
  const RoleWords& role = *group.front().role;
  if (people[0].size() == 1 && people[1].size() == 1) {
    PairFiles pair;
    pair.first = people[0].front()->file;
    pair.second = people[1].front()->file;
    if (role.tells_leader) pair.leader_source = "name";
    NamePair(group.front(), &pair);
    return Add(std::move(pair), pairing);
  }
  for (const Parsed& one : group) {
    const bool alone = people[one.second ? 0 : 1].empty();
    pairing->refused.push_back(
        {one.file, alone ? absl::StrCat("other person: expected a file that ends in ",
                                        one.second ? role.first : role.second, ", got none")
                         : absl::StrCat("files: expected one for each person of ",
                                        absl::StrJoin(one.words, "/"), ", got more")});
  }
}

}  // namespace

std::string ToLabel(absl::string_view text) {
  std::string label;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (absl::ascii_isalnum(byte)) {
      label.push_back(absl::ascii_tolower(byte));
    } else if (!label.empty() && label.back() != '_') {
      label.push_back('_');
    }
  }
  return std::string(absl::StripSuffix(label, "_"));
}

Pairing PairByName(const std::vector<std::string>& files) {
  Pairing pairing;
  std::map<std::pair<std::string, const char*>, std::vector<Parsed>> groups;
  for (const std::string& file : files) {
    Parsed parsed = ParseName(file);
    if (parsed.role != nullptr) {
      groups[{absl::StrJoin(parsed.words, "/"), parsed.role->first}].push_back(std::move(parsed));
      continue;
    }
    PairFiles pair;
    pair.first = pair.second = file;
    NamePair(parsed, &pair);
    Add(std::move(pair), &pairing);
  }
  for (const auto& [name, group] : groups) AddGroup(group, &pairing);
  std::sort(pairing.pairs.begin(), pairing.pairs.end(),
            [](const PairFiles& a, const PairFiles& b) { return a.first < b.first; });
  MakeNamesUnique(&pairing.pairs);
  return pairing;
}

absl::StatusOr<Pairing> PairByTable(absl::string_view table, absl::string_view source,
                                    const std::vector<std::string>& files) {
  DUET_TRY(const std::vector<dataset::TableRow> rows,
           dataset::ReadTable(table, source, {"leader", "follower", "label"}));
  const std::set<std::string> known(files.begin(), files.end());
  Pairing pairing;
  for (const dataset::TableRow& row : rows) {
    PairFiles pair;
    pair.first = row["leader"];
    pair.second = row["follower"].empty() ? pair.first : row["follower"];
    pair.leader_source = "table";
    NamePair(ParseName(pair.first), &pair);
    pair.label = ToLabel(row["label"]);
    if (pair.label.empty()) {
      return base::ErrorAt(source, row.line, "label: expected the name of a class, got none");
    }
    pair.subjects = row.Names("subjects");
    const std::string* missing = known.count(pair.first) == 0    ? &pair.first
                                 : known.count(pair.second) == 0 ? &pair.second
                                                                 : nullptr;
    if (missing != nullptr) {
      pairing.refused.push_back({*missing, absl::StrCat("expected a motion file, as ", source, ":",
                                                        row.line, " names it, got none")});
      continue;
    }
    pairing.pairs.push_back(std::move(pair));
  }
  MakeNamesUnique(&pairing.pairs);
  return pairing;
}

}  // namespace duet::importing
