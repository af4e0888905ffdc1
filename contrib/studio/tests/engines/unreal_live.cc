// Drives the live partner of the page for Unreal. `FRAMES`: the leader's frames, lines of numbers
// in the engine's axes, in the order of the partner's joints; writes the messages that it sends, as
// hexadecimal lines. `FRAMES MESSAGES`: also receives such lines, and writes the bones after each.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include "DuetPartner.h"

namespace {

constexpr const char* kBones[] = {"spine_02",   "neck_01", "head",       "upperarm_l",
                                  "lowerarm_l", "hand_l",  "upperarm_r", "lowerarm_r",
                                  "hand_r",     "thigh_l", "calf_l",     "foot_l",
                                  "thigh_r",    "calf_r",  "foot_r"};

// A person who faces +y with lowered arms, and whose bones have axes of their own.
void Stand(UPoseableMeshComponent* mesh) {
  int count = 0;
  const auto add = [&](const char* name, const char* parent, double x, double y, double z) {
    const double length = std::sqrt(14);
    const FQuat rest(FVector(1 / length, 2 / length, 3 / length), 0.6 * ++count);
    mesh->bones[name] = {parent, FVector(x, y, z), rest, rest};
  };
  add("pelvis", "", 0, 0, 95);
  add("spine_02", "pelvis", 0, 0, 15);
  add("spine_03", "spine_02", 0, 0, 15);
  add("neck_01", "spine_03", 0, 0, 25);
  add("head", "neck_01", 0, 0, 8);
  for (const int side : {1, -1}) {
    const std::string end = side > 0 ? "_l" : "_r";
    add(("upperarm" + end).c_str(), "spine_03", 18 * side, 0, 18);
    add(("lowerarm" + end).c_str(), ("upperarm" + end).c_str(), 20 * side, 3, -20);
    add(("hand" + end).c_str(), ("lowerarm" + end).c_str(), 15 * side, 8, -18);
    add(("thigh" + end).c_str(), "pelvis", 9 * side, 0, -5);
    add(("calf" + end).c_str(), ("thigh" + end).c_str(), 2 * side, 1, -42);
    add(("foot" + end).c_str(), ("calf" + end).c_str(), 0, -2, -40);
  }
}

void Write(const char* name, const FVector& v) {
  std::printf("%s %.4f %.4f %.4f\n", name, v.X, v.Y, v.Z);
}

int Placement() {
  Write("apart", DuetPlacement::Apart({10, 0, 90}, {0, 0, 95}, 30));
  Write("apart", DuetPlacement::Apart({300, 0, 90}, {0, 0, 95}, 30));
  const FVector forward(0, 1, 0);
  for (const double most : {30, 120}) {
    Write("turn", {DuetPlacement::TurnToFace({0, 0, 90}, forward, {200, 0, 90}, most), 0, 0});
  }
  Write("turn", {DuetPlacement::TurnToFace({0, 0, 90}, forward, {-200, 0, 90}, 30), 0, 0});
  return 0;
}

std::string FromHex(const std::string& line) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
    bytes.push_back(static_cast<char>(std::stoi(line.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

void Receive(ADuetPartner* partner, const std::string& bytes) {
  auto& event = FWebSocketsModule::Get().socket->OnRawMessage();
  const std::size_t half = bytes.size() / 2;  // in two fragments
  if (half > 0) event.Broadcast(bytes.data(), half, bytes.size() - half);
  event.Broadcast(bytes.data() + half, bytes.size() - half, 0);
  std::printf("message\n");
  for (const auto& [name, bone] : partner->Follower->bones) {
    Write(
        name.c_str(),
        partner->Follower->GetBoneTransformByName(name, EBoneSpaces::ComponentSpace).GetLocation());
  }
}

}  // namespace

int main(int count, char** words) {
  if (count == 1) return Placement();
  ADuetPartner partner;
  USkeletalMeshComponent leader;
  leader.places["pelvis"] = FVector();
  for (const char* bone : kBones) leader.places[bone] = FVector();
  Stand(partner.Follower);
  partner.Leader = &leader;
  partner.LeastDistance = partner.HeadHeight = 0;
  partner.MostAside = 180;
  partner.BeginPlay();
  IWebSocket& socket = *FWebSocketsModule::Get().socket;
  partner.Tick(0.04f);  // before the connection: nothing is sent
  socket.OnConnected().Broadcast();
  std::ifstream frames(words[1]);
  for (std::string line; std::getline(frames, line);) {
    std::istringstream values(line);
    for (const char* bone : kBones) {
      FVector& at = leader.places[bone];
      values >> at.X >> at.Y >> at.Z;
    }
    partner.Tick(1.0f / 30);
  }
  if (count == 2) {
    for (const std::string& message : socket.sent) {
      for (const char byte : message) std::printf("%02x", static_cast<unsigned char>(byte));
      std::printf("\n");
    }
    return 0;
  }
  std::ifstream messages(words[2]);
  for (std::string line; std::getline(messages, line);) Receive(&partner, FromHex(line));
  return 0;
}
