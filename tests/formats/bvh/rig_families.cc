#include "tests/formats/bvh/rig_families.h"

#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "model/retargeting/rotation.h"

namespace duet::test {
namespace {

using formats::bvh::BvhChannel;
using formats::bvh::BvhDocument;
using formats::bvh::BvhJoint;
using retargeting::Vec3d;

// '%' in a name stands for the side.
struct Names {
  std::string root;  // above the pelvis; empty for none
  std::string pelvis;
  std::vector<std::string> spine, neck;  // the last of the neck is the head
  std::string hip_bone;                  // between pelvis and thigh; empty for none
  std::string clavicle, upper_arm, twist, forearm, hand, finger;  // twist, finger may be empty
  std::string thigh, shin, foot, toe;
  std::string left, right;
};

struct Style {
  std::string rotations = "ZXY";
  bool all_move = false;  // six channels on every joint
  double unit = 0.01;     // metres
  bool z_up = false;
  double arms_down = 0;  // degrees below a T pose
  double size = 1;
};

class RigMaker {
 public:
  RigMaker(const Names& names, const Style& style) : names_(names), style_(style) {}

  BvhDocument Make() {
    const Vec3d hips = {0, 0.95, 0};
    int pelvis = -1;
    if (!names_.root.empty()) {
      // On the floor, or where a centre of mass is.
      const bool floor = names_.root == "root";
      pelvis = Add(names_.root, -1, floor ? Vec3d{} : hips);
    }
    pelvis = Add(names_.pelvis, pelvis, hips);
    int chest = pelvis;
    for (std::size_t i = 0; i < names_.spine.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(names_.spine.size());
      chest = Add(names_.spine[i], chest, {0, 1.02 + 0.36 * share, -0.01});
    }
    int neck = chest;
    for (std::size_t i = 0; i < names_.neck.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(names_.neck.size());
      neck = Add(names_.neck[i], neck, {0, 1.45 + 0.16 * share, 0.02 * share});
    }
    AddEnd(neck, {0, 1.76, 0.02});
    for (const bool left : {true, false}) {
      AddArm(chest, left);
      AddLeg(pelvis, left);
    }
    Finish();
    return std::move(document_);
  }

 private:
  std::string Sided(const std::string& name, bool left) const {
    return absl::StrReplaceAll(name, {{"%", left ? names_.left : names_.right}});
  }

  int Add(const std::string& name, int parent, Vec3d at) {
    BvhJoint joint;
    joint.name = name;
    joint.parent = parent;
    if (parent < 0 || style_.all_move) {
      joint.channels = {BvhChannel::kXPosition, BvhChannel::kYPosition, BvhChannel::kZPosition};
    }
    for (char axis : style_.rotations) {
      joint.channels.push_back(axis == 'X'   ? BvhChannel::kXRotation
                               : axis == 'Y' ? BvhChannel::kYRotation
                                             : BvhChannel::kZRotation);
    }
    document_.joints.push_back(joint);
    at_.push_back(at * style_.size);
    return static_cast<int>(at_.size()) - 1;
  }

  void AddEnd(int parent, Vec3d at) {
    BvhJoint end;
    end.name = document_.joints[static_cast<std::size_t>(parent)].name + ".end";
    end.parent = parent;
    end.end_site = true;
    document_.joints.push_back(end);
    at_.push_back(at * style_.size);
  }

  void AddArm(int chest, bool left) {
    const double side = left ? 1 : -1;
    const Vec3d shoulder = {side * 0.17, 1.42, 0};
    const double down = style_.arms_down * 3.14159265358979323846 / 180;
    const Vec3d along = {side * std::cos(down), -std::sin(down), 0};
    const auto arm = [&](double length) { return shoulder + along * length; };
    int joint = Add(Sided(names_.clavicle, left), chest, {side * 0.03, 1.40, 0});
    joint = Add(Sided(names_.upper_arm, left), joint, shoulder);
    if (!names_.twist.empty()) joint = Add(Sided(names_.twist, left), joint, arm(0.14));
    joint = Add(Sided(names_.forearm, left), joint, arm(0.28));
    joint = Add(Sided(names_.hand, left), joint, arm(0.53));
    if (!names_.finger.empty()) joint = Add(Sided(names_.finger, left), joint, arm(0.62));
    AddEnd(joint, arm(0.70));
  }

  void AddLeg(int pelvis, bool left) {
    const double side = left ? 1 : -1;
    int joint = pelvis;
    if (!names_.hip_bone.empty()) {
      joint = Add(Sided(names_.hip_bone, left), joint, {side * 0.03, 0.94, 0});
    }
    joint = Add(Sided(names_.thigh, left), joint, {side * 0.095, 0.91, 0});
    joint = Add(Sided(names_.shin, left), joint, {side * 0.095, 0.49, 0.01});
    joint = Add(Sided(names_.foot, left), joint, {side * 0.095, 0.08, 0});
    if (!names_.toe.empty())
      joint = Add(Sided(names_.toe, left), joint, {side * 0.095, 0.02, 0.13});
    AddEnd(joint, {side * 0.095, 0.02, 0.2});
  }

  Vec3d InFile(Vec3d at) const {
    return (style_.z_up ? Vec3d{at.x, -at.z, at.y} : at) * (1 / style_.unit);
  }

  // Offsets and the one frame, in the file's unit and axes.
  void Finish() {
    document_.frame_time_s = 1.0 / 30;
    document_.frame_count = 1;
    for (std::size_t j = 0; j < document_.joints.size(); ++j) {
      BvhJoint& joint = document_.joints[j];
      const Vec3d place =
          joint.parent < 0 ? at_[j] : at_[j] - at_[static_cast<std::size_t>(joint.parent)];
      if (joint.parent >= 0) joint.offset = InFile(place);
      const bool moves = joint.channels.size() == 6;
      for (double value : {InFile(place).x, InFile(place).y, InFile(place).z}) {
        if (moves) document_.values.push_back(static_cast<float>(value));
      }
      for (int turn = 0; turn < 3 && !joint.channels.empty(); ++turn) {
        document_.values.push_back(0);
      }
    }
  }

  const Names& names_;
  const Style& style_;
  BvhDocument document_;
  std::vector<Vec3d> at_;  // [joints], metres, y up
};

// family | root | pelvis | spine | neck | hip bone | arm | leg | left, right
struct Row {
  const char* names;
  Style style;
};
const Row kRows[] = {
    {"CMU |  | Hips | LowerBack, Spine, Spine1 | Neck, Neck1, Head | %HipJoint"
     " | %Shoulder, %Arm, , %ForeArm, %Hand, %HandIndex1 | %UpLeg, %Leg, %Foot, %ToeBase | Left, "
     "Right",
     {"ZYX", false, 0.0254 / 0.45}},
    {"Mixamo |  | mixamorig:Hips | mixamorig:Spine, mixamorig:Spine1, mixamorig:Spine2 | "
     "mixamorig:Neck, mixamorig:Head | "
     " | mixamorig:%Shoulder, mixamorig:%Arm, , mixamorig:%ForeArm, mixamorig:%Hand, "
     "mixamorig:%HandMiddle1 | mixamorig:%UpLeg, mixamorig:%Leg, mixamorig:%Foot, "
     "mixamorig:%ToeBase | Left, Right",
     {"XYZ"}},
    {"3ds Max Biped | Bip01 | Bip01 Pelvis | Bip01 Spine, Bip01 Spine1 | Bip01 Neck, Bip01 Head | "
     " | Bip01 % Clavicle, Bip01 % UpperArm, , Bip01 % Forearm, Bip01 % Hand, Bip01 % Finger0 | "
     "Bip01 % Thigh, Bip01 % Calf, Bip01 % Foot, Bip01 % Toe0 | L, R",
     {"YXZ", false, 0.0254, true, 60}},
    {"Rokoko |  | Hips | Spine1, Spine2, Spine3, Spine4 | Neck, Head | "
     " | %Shoulder, %Arm, , %ForeArm, %Hand, %Finger3Metacarpal | %Thigh, %Shin, %Foot, %Toe | "
     "Left, Right",
     {"YXZ", true}},
    {"Xsens |  | Hips | Chest, Chest2, Chest3, Chest4 | Neck, Head | "
     " | %Collar, %Shoulder, , %Elbow, %Wrist,  | %Hip, %Knee, %Ankle, %Toe | Left, Right",
     {"YXZ", false, 0.01, false, 0, 1.05}},
    {"OptiTrack |  | Hip | Ab, Chest | Neck, Head | "
     " | %Shoulder, %UArm, , %FArm, %Hand,  | %Thigh, %Shin, %Foot, %Toe | L, R",
     {"XYZ", true, 0.001}},
    {"Unreal mannequin | root | pelvis | spine_01, spine_02, spine_03 | neck_01, head | "
     " | clavicle_%, upperarm_%, , lowerarm_%, hand_%, middle_01_% | thigh_%, calf_%, foot_%, "
     "ball_% | l, r",
     {"ZXY", true, 0.01, true, 45}},
    {"Rigify |  | spine | spine.001, spine.002, spine.003 | neck, head | "
     " | shoulder.%, upper_arm.%, upper_arm.%.001, forearm.%, hand.%, f_middle.01.% | thigh.%, "
     "shin.%, foot.%, toe.% | L, R",
     {"XYZ", false, 1, true, 40, 0.95}},
    {"VRM |  | J_Bip_C_Hips | J_Bip_C_Spine, J_Bip_C_Chest, J_Bip_C_UpperChest | J_Bip_C_Neck, "
     "J_Bip_C_Head | "
     " | J_Bip_%_Shoulder, J_Bip_%_UpperArm, , J_Bip_%_LowerArm, J_Bip_%_Hand, J_Bip_%_Middle1 | "
     "J_Bip_%_UpperLeg, J_Bip_%_LowerLeg, J_Bip_%_Foot, J_Bip_%_ToeBase | L, R",
     {"YXZ", false, 1, false, 0, 0.9}},
    {"SMPL |  | Pelvis | Spine1, Spine2, Spine3 | Neck, Head | "
     " | %_Collar, %_Shoulder, , %_Elbow, %_Wrist, %_Hand | %_Hip, %_Knee, %_Ankle, %_Foot | L, R",
     {"XYZ", false, 1}},
    {"Kinect |  | SpineBase | SpineMid, SpineShoulder | Neck, Head | "
     " | Clavicle%, Shoulder%, , Elbow%, Wrist%, Hand% | Hip%, Knee%, Ankle%, Foot% | Left, Right",
     {"ZXY", false, 0.01, false, 85}}};

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (absl::string_view part : absl::StrSplit(text, separator)) {
    parts.emplace_back(absl::StripAsciiWhitespace(part));
  }
  return parts;
}

}  // namespace

std::vector<RigFamily> RigFamilies() {
  std::vector<RigFamily> families;
  for (const Row& row : kRows) {
    const std::vector<std::string> cells = Split(row.names, '|');
    const std::vector<std::string> arm = Split(cells[6], ','), leg = Split(cells[7], ','),
                                   sides = Split(cells[8], ',');
    const Names names = {cells[1],
                         cells[2],
                         Split(cells[3], ','),
                         Split(cells[4], ','),
                         cells[5],
                         arm[0],
                         arm[1],
                         arm[2],
                         arm[3],
                         arm[4],
                         arm[5],
                         leg[0],
                         leg[1],
                         leg[2],
                         leg[3],
                         sides[0],
                         sides[1]};
    families.push_back({cells[0], RigMaker(names, row.style).Make()});
  }
  return families;
}

}  // namespace duet::test
