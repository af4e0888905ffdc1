#ifndef DUET_CLIENT_CAPTURE_VMC_READER_H_
#define DUET_CLIENT_CAPTURE_VMC_READER_H_

#include <array>
#include <bitset>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/capture/humanoid.h"
#include "client/capture/osc.h"
#include "client/capture/stream_reader.h"
#include "model/retargeting/rotation.h"

namespace duet::client::capture {

// Reads the Virtual Motion Capture protocol (VMC, v3.1 of its specification): bones relative to
// their parents, in Unity's left-handed axes, as OSC over UDP.
//
// - A frame may span datagrams. It ends when every bone of the frames before has arrived, at the
//   next time (/VMC/Ext/T), or at a repeated bone.
// - The joints are the 22 bones of the body. A bone that a frame leaves out keeps its last
//   transform. The children of a bone that never came are chained to its nearest ancestor, and the
//   bone itself stands between the two; without children it is in its rest pose.
// - Bones at position zero, as senders of rotations have them, get the offsets of the built-in
//   person.
// - Names may also be those of VRM 1.0 (leftUpperArm) or of files (docs/formats.md).
// - Fingers, face, cameras and devices are ignored.
//
// Source: github.com/sh-akira/VirtualMotionCaptureProtocol.
class VmcReader : public StreamReader {
 public:
  VmcReader();

  const std::vector<std::string>& joint_names() const override { return names_; }
  absl::Status Read(absl::string_view datagram, std::vector<CaptureFrame>* frames) override;
  std::vector<std::string> TakeNotes() override;
  std::string Missing() const override;

 private:
  // Relative to the parent, in Unity's axes.
  struct Transform {
    retargeting::Vec3d position;
    retargeting::Quaternion rotation;
  };
  using Bones = std::bitset<kHumanoidBoneCount>;

  absl::Status ReadMessage(const OscMessage& message, std::vector<CaptureFrame>* frames);
  absl::Status ReadBone(const OscMessage& message, std::vector<CaptureFrame>* frames);
  static absl::StatusOr<Transform> ReadTransform(const OscMessage& message,
                                                 absl::string_view* name);
  void CloseFrame(std::vector<CaptureFrame>* frames);
  std::vector<motion::Vec3> Positions() const;
  void PlaceMissing(std::vector<retargeting::Vec3d>* positions) const;
  void MakeNotes();

  std::vector<std::string> names_;
  Transform root_;
  std::array<std::optional<Transform>, kHumanoidBoneCount> bones_;
  Bones arrived_;                  // in the open frame
  Bones previous_, expected_;      // of the last frame; of the last two
  std::optional<double> seconds_;  // since the last frame
  int frame_count_ = 0;
  std::vector<std::string> notes_;
  std::set<std::string> other_bones_, other_addresses_;  // that arrived, a few of them
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_VMC_READER_H_
