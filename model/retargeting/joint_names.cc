#include "model/retargeting/joint_names.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"

namespace duet::retargeting {
namespace {

using WordList = std::vector<std::string>;

// Numbers at the end of names are running ones if this share of the names, and at least so many,
// have one, and this share of the numbers is different.
constexpr double kNumbered = 0.75;
constexpr std::size_t kFewestNumbered = 8;
constexpr double kDifferent = 0.9;

struct AliasRow {
  const char* base;  // the skeleton's
  std::vector<std::string> aliases;
};

// The table of docs/formats.md. The order within a row matters: `LeftShoulder` is the collar bone
// in files with a `LeftArm`, and the shoulder in others.
const std::vector<AliasRow>& AliasTable() {
  static const auto* const kTable = new std::vector<AliasRow>{
      {"head", {"head", "skull"}},
      {"headtop", {"headtop", "headtopend", "headend", "headnub"}},
      {"neck", {"neck", "neck1", "neck01", "lowerneck", "necklower"}},
      {"hips", {"hips", "pelvis", "hip"}},
      {"shoulder",
       {"upperarm", "uparm", "uarm", "upperarm01", "arm", "humerus", "shldr", "shldrbend",
        "upperarmfk", "shoulder"}},
      {"elbow",
       {"elbow", "forearm", "farm", "lowerarm", "lowarm", "loarm", "lowerarm01", "forearmbend",
        "radius", "forearmfk"}},
      {"hand", {"wrist", "hand", "handfk", "palm"}},
      {"hip",
       {"upleg", "upperleg", "upperleg01", "thigh", "thighbend", "femur", "thighfk", "hip", "leg"}},
      {"knee",
       {"knee", "shin", "calf", "lowerleg", "lowleg", "loleg", "lowerleg01", "tibia", "shinfk",
        "leg"}},
      {"foot", {"ankle", "foot", "footfk"}},
      {"toe", {"toe", "toebase", "toes", "ball", "toe0", "toe11", "bigtoe", "footend", "foot"}}};
  return *kTable;
}

bool IsNoise(const std::string& word) {
  static const auto* const kNoise = new std::vector<std::string>{
      "mixamorig", "bip",  "bip01",    "bip001", "valvebiped", "valve", "biped", "character1",
      "def",       "org",  "mch",      "jnt",    "j",          "b",     "bn",    "skel",
      "skeleton",  "root", "armature", "c",      "cc",         "base"};
  return std::find(kNoise->begin(), kNoise->end(), word) != kNoise->end();
}

bool IsSeparator(char c) { return c == ' ' || c == '_' || c == '-' || c == '.'; }
bool IsUpper(char c) { return absl::ascii_isupper(static_cast<unsigned char>(c)); }
bool IsLower(char c) { return absl::ascii_islower(static_cast<unsigned char>(c)); }

// "LeftUpLeg" -> left up leg; "RThigh" -> r thigh; "LEFT_HIP" -> left hip.
WordList Words(absl::string_view name) {
  WordList words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(std::exchange(word, ""));
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (IsSeparator(name[i])) {
      end_word();
      continue;
    }
    const bool next_is_lower = i + 1 < name.size() && IsLower(name[i + 1]);
    if (i > 0 && IsUpper(name[i]) && (!IsUpper(name[i - 1]) || next_is_lower)) end_word();
    word.push_back(absl::ascii_tolower(static_cast<unsigned char>(name[i])));
  }
  end_word();
  return words;
}

BodySide SideOf(absl::string_view word) {
  if (word == "left" || word == "l") return BodySide::kLeft;
  if (word == "right" || word == "r") return BodySide::kRight;
  return BodySide::kMiddle;
}

bool IsTrunk(absl::string_view base) {
  return base == "head" || base == "headtop" || base == "neck" || base == "hips";
}

bool IsLimbAlias(absl::string_view base) {
  for (const AliasRow& row : AliasTable()) {
    if (IsTrunk(row.base)) continue;
    if (std::find(row.aliases.begin(), row.aliases.end(), base) != row.aliases.end()) return true;
  }
  return false;
}

// Sides without a separator: "leftarm", "armleft", "lfemur".
void SplitJoinedSide(ParsedJointName* name) {
  const std::pair<const char*, BodySide> sides[] = {{"left", BodySide::kLeft},
                                                    {"right", BodySide::kRight},
                                                    {"l", BodySide::kLeft},
                                                    {"r", BodySide::kRight}};
  for (const auto& [text, side] : sides) {
    absl::string_view base = name->base;
    if (!absl::ConsumePrefix(&base, text) && !absl::ConsumeSuffix(&base, text)) continue;
    if (!IsLimbAlias(base)) continue;
    *name = {side, std::string(base)};
    return;
  }
}

absl::string_view WithoutNamespace(absl::string_view name) {
  const std::size_t space = name.find_last_of(":|");
  return space == absl::string_view::npos ? name : name.substr(space + 1);
}

ParsedJointName ParseWords(WordList words) {
  while (words.size() > 1 && IsNoise(words.front())) words.erase(words.begin());
  ParsedJointName parsed;
  for (auto word = words.begin(); word != words.end() && words.size() > 1; ++word) {
    parsed.side = SideOf(*word);
    if (parsed.side == BodySide::kMiddle) continue;
    words.erase(word);
    break;
  }
  parsed.base = absl::StrJoin(words, "");
  if (parsed.side == BodySide::kMiddle) SplitJoinedSide(&parsed);
  return parsed;
}

bool IsNumber(absl::string_view word) {
  return std::all_of(word.begin(), word.end(),
                     [](unsigned char c) { return absl::ascii_isdigit(c); });
}

// Removes the number of the joint in its file, which some programs append (LeftArm_08): most names
// end in a number, and hardly any number is there twice.
void StripRunningNumbers(std::vector<WordList>* all) {
  std::set<std::string> numbers;
  std::vector<WordList*> numbered;
  for (WordList& words : *all) {
    if (words.size() < 2 || !IsNumber(words.back())) continue;
    numbers.insert(words.back());
    numbered.push_back(&words);
  }
  const auto count = static_cast<double>(numbered.size());
  if (numbered.size() < kFewestNumbered) return;
  if (count < kNumbered * static_cast<double>(all->size())) return;
  if (static_cast<double>(numbers.size()) < kDifferent * count) return;
  for (WordList* words : numbered) words->pop_back();
}

}  // namespace

ParsedJointName ParseJointName(absl::string_view name) {
  return ParseWords(Words(WithoutNamespace(name)));
}

std::vector<ParsedJointName> ParseJointNames(const std::vector<std::string>& names) {
  std::vector<WordList> all;
  for (const std::string& name : names) all.push_back(Words(WithoutNamespace(name)));
  StripRunningNumbers(&all);
  std::vector<ParsedJointName> parsed;
  for (WordList& words : all) parsed.push_back(ParseWords(std::move(words)));
  return parsed;
}

std::vector<std::string> JointAliases(const std::string& base) {
  for (const AliasRow& row : AliasTable()) {
    if (row.base == base) return row.aliases;
  }
  std::vector<std::string> aliases = {base};
  for (const AliasRow& row : AliasTable()) {
    const bool same_joint =
        std::find(row.aliases.begin(), row.aliases.end(), base) != row.aliases.end();
    if (same_joint) aliases.insert(aliases.end(), row.aliases.begin(), row.aliases.end());
  }
  return aliases;
}

bool IsNeck(const ParsedJointName& name) {
  return name.side == BodySide::kMiddle && absl::StrContains(name.base, "neck") &&
         !absl::EndsWith(name.base, "end");
}

bool IsSpine(const ParsedJointName& name) {
  if (name.side != BodySide::kMiddle || absl::EndsWith(name.base, "end")) return false;
  for (const char* part : {"torso", "spine", "chest", "back", "thorax", "abdomen", "waist"}) {
    if (absl::StrContains(name.base, part)) return true;
  }
  return false;
}

}  // namespace duet::retargeting
