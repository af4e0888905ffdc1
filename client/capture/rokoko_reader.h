#ifndef DUET_CLIENT_CAPTURE_ROKOKO_READER_H_
#define DUET_CLIENT_CAPTURE_ROKOKO_READER_H_

#include <cstddef>
#include <string>
#include <vector>

#include "client/capture/stream_reader.h"

namespace duet::client::capture {

// Reads the live stream of Rokoko Studio: JSON v3, plain or as an LZ4 frame. Joints are at world
// positions in Unity's left-handed axes. Every datagram is a frame.
//
// Toes that an actor does not have are placed at the feet.
// The first actor with a body leads, and later the actor of the same name; others are ignored.
class RokokoReader : public StreamReader {
 public:
  static constexpr std::size_t kMaxJsonBytes = 512 * 1024;  // decompressed

  RokokoReader();

  const std::vector<std::string>& joint_names() const override { return names_; }
  absl::Status Read(absl::string_view datagram, std::vector<CaptureFrame>* frames) override;
  std::vector<std::string> TakeNotes() override;
  std::string Missing() const override;

 private:
  std::vector<std::string> names_;
  std::string actor_;  // empty: none has come
  bool others_ = false, no_toes_ = false;
  std::vector<std::string> notes_;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_ROKOKO_READER_H_
