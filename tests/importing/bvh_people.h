#ifndef DUET_TESTS_IMPORTING_BVH_PEOPLE_H_
#define DUET_TESTS_IMPORTING_BVH_PEOPLE_H_

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/support/temporary_folder.h"

namespace duet::importing {

// One of two people who kick or shove each other, as a BVH file of 20 joints with the names of
// common tools, centimetres, y up. The leader acts; the follower, 1.2 m ahead and face to face,
// steps back and bends a little later.
struct BvhPerson {
  std::string action = "kick";  // or "shove"
  bool leads = true;
  int variant = 0;  // acts later and farther
  int frames = 60;
  int frame_rate_hz = 60;
  double scale = 1;         // units of the file in a centimetre
  std::string prefix = "";  // of every joint's name
};

inline const std::vector<std::string>& BvhJointNames() {
  static const auto* const names = new std::vector<std::string>{
      "Hips",         "Spine",      "Spine1",      "Chest",     "Neck",
      "Head",         "LeftArm",    "LeftForeArm", "LeftHand",  "RightArm",
      "RightForeArm", "RightHand",  "LeftUpLeg",   "LeftLeg",   "LeftFoot",
      "LeftToeBase",  "RightUpLeg", "RightLeg",    "RightFoot", "RightToeBase"};
  return *names;
}

namespace internal {

struct BvhLine {
  int depth;
  double x, y, z;  // OFFSET in centimetres
};

// In the order of BvhJointNames.
inline const std::vector<BvhLine>& BvhTree() {
  static const auto* const tree = new std::vector<BvhLine>{
      {0, 0, 0, 0},   {1, 0, 10, 0},   {2, 0, 10, 0},  {3, 0, 12, 0},  {4, 0, 14, 0},
      {5, 0, 8, 0},   {4, 18, 8, 0},   {5, 28, 0, 0},  {6, 26, 0, 0},  {4, -18, 8, 0},
      {5, -28, 0, 0}, {6, -26, 0, 0},  {1, 10, -4, 0}, {2, 0, -42, 0}, {3, 0, -40, 0},
      {4, 0, -5, 12}, {1, -10, -4, 0}, {2, 0, -42, 0}, {3, 0, -40, 0}, {4, 0, -5, 12}};
  return *tree;
}

inline std::string Offset(double x, double y, double z, double scale) {
  return absl::StrCat("OFFSET ", x * scale, " ", y * scale, " ", z * scale, "\n");
}

// 0, then up to 1 and back between `begin` and `end` seconds.
inline double Bump(double t, double begin, double end) {
  return t <= begin || t >= end ? 0 : std::pow(std::sin(M_PI * (t - begin) / (end - begin)), 2);
}

}  // namespace internal

inline std::string BvhText(const BvhPerson& person) {
  std::string text = "HIERARCHY\n";
  const std::vector<internal::BvhLine>& tree = internal::BvhTree();
  for (std::size_t j = 0; j < tree.size(); ++j) {
    absl::StrAppend(&text, j == 0 ? "ROOT " : "JOINT ", person.prefix, BvhJointNames()[j], "\n{\n",
                    internal::Offset(tree[j].x, tree[j].y, tree[j].z, person.scale),
                    j == 0 ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
                             "Yrotation\n"
                           : "CHANNELS 3 Zrotation Xrotation Yrotation\n");
    const int next = j + 1 < tree.size() ? tree[j + 1].depth : 0;
    if (next > tree[j].depth) continue;
    absl::StrAppend(&text, "End Site\n{\n", internal::Offset(0, 0, 8, person.scale), "}\n");
    for (int depth = tree[j].depth; depth >= next; --depth) text += "}\n";
  }
  absl::StrAppend(&text, "MOTION\nFrames: ", person.frames,
                  "\nFrame Time: ", 1.0 / person.frame_rate_hz, "\n");
  for (int frame = 0; frame < person.frames; ++frame) {
    const double t = static_cast<double>(frame) / person.frame_rate_hz;
    const double begin = 0.1 + 0.02 * person.variant + (person.leads ? 0 : 0.2);
    const double act = internal::Bump(t, begin, begin + 0.6) * (1 + 0.03 * person.variant);
    const double away = person.leads ? 0 : 120 + 20 * act, turn = person.leads ? 0 : 180;
    absl::StrAppend(&text, 0, " ", 91 * person.scale, " ", away * person.scale, " 0 0 ", turn);
    for (std::size_t j = 1; j < tree.size(); ++j) {
      const std::string& name = BvhJointNames()[j];
      double z = 0, x = 2 * std::sin(5 * t + 0.4 * static_cast<double>(j)), y = 0;
      if (name == "LeftArm") z = -75;
      if (name == "RightArm") z = 75;
      if (person.leads && person.action == "kick" && name == "RightUpLeg") x -= 70 * act;
      if (person.leads && person.action == "shove" && name == "LeftArm") y -= 70 * act;
      if (person.leads && person.action == "shove" && name == "RightArm") y += 70 * act;
      if (!person.leads && name == "Spine") x -= 12 * act;
      absl::StrAppend(&text, " ", z, " ", x, " ", y);
    }
    text += "\n";
  }
  return text;
}

// Writes <action>_<number>_a.bvh and _b.bvh into a folder; in every second pair b leads.
inline void WriteBvhPairs(const std::filesystem::path& folder, int pairs_a_class,
                          const BvhPerson& common = {}) {
  std::filesystem::create_directories(folder);
  for (const char* action : {"kick", "shove"}) {
    for (int i = 0; i < pairs_a_class; ++i) {
      for (const bool is_a : {true, false}) {
        BvhPerson person = common;
        person.action = action;
        person.variant = i;
        person.leads = is_a == (i % 2 == 0);
        test::WriteTestFile(folder / absl::StrCat(action, "_0", i + 1, is_a ? "_a" : "_b", ".bvh"),
                            BvhText(person));
      }
    }
  }
}

}  // namespace duet::importing

#endif  // DUET_TESTS_IMPORTING_BVH_PEOPLE_H_
