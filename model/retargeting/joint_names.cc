#include "model/retargeting/joint_names.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"

namespace duet::retargeting {
namespace {

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
      "mixamorig",  "bip",  "bip01",    "bip001", "valvebiped", "valve", "biped",
      "character1", "def",  "org",      "mch",    "jnt",        "j",     "b",
      "bn",         "skel", "skeleton", "root",   "armature",   "c"};
  return std::find(kNoise->begin(), kNoise->end(), word) != kNoise->end();
}

bool IsSeparator(char c) { return c == ' ' || c == '_' || c == '-' || c == '.'; }
bool IsUpper(char c) { return absl::ascii_isupper(static_cast<unsigned char>(c)); }
bool IsLower(char c) { return absl::ascii_islower(static_cast<unsigned char>(c)); }

// "LeftUpLeg" -> left up leg; "RThigh" -> r thigh; "LEFT_HIP" -> left hip.
std::vector<std::string> Words(absl::string_view name) {
  std::vector<std::string> words;
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

}  // namespace

ParsedJointName ParseJointName(absl::string_view name) {
  const std::size_t space = name.find_last_of(":|");
  if (space != absl::string_view::npos) name.remove_prefix(space + 1);
  std::vector<std::string> words = Words(name);
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
