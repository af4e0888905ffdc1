#ifndef DUET_TESTS_CLIENT_SUPPORT_LIVE_MIRROR_H_
#define DUET_TESTS_CLIENT_SUPPORT_LIVE_MIRROR_H_

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "duet/v1/synthesis.grpc.pb.h"
#include "grpcpp/server_context.h"
#include "grpcpp/support/sync_stream.h"

namespace duet::test {

using LiveServerStream =
    grpc::ServerReaderWriter<v1::SynthesizeLiveResponse, v1::SynthesizeLiveRequest>;

// Answers live sessions as the contract describes: the follower is the leader moved by one metre in
// x, plus the weight of the class "hug" at that frame in y. It keeps what it was asked.
//
// With rotations, the rig has one joint, which turns steadily about x by 0.5 radians in a frame.
//
// A resumed session continues from the history's frames, so a client that sends a wrong history
// gets a motion with a jump.
class LiveMirror {
 public:
  // Called before each answered frame, with the number of the stream, from 0, and the frame. A
  // status that is not OK ends the stream.
  std::function<grpc::Status(int stream, int frame)> before_frame;
  // Frames after which a stream sends LIVE_NOTICE_KIND_DRAINING; absent: never.
  std::function<bool(int stream, int frame)> drains;
  int history_frames = 5;
  std::string model_name = "dancer";

  grpc::Status Run(grpc::ServerContext* context, LiveServerStream* stream);

  std::vector<v1::LiveStart> starts() const;
  // Number of LeaderFrames messages of all streams.
  int messages() const;

 private:
  mutable std::mutex mutex_;
  std::vector<v1::LiveStart> starts_;
  int messages_ = 0;
};

}  // namespace duet::test

#endif  // DUET_TESTS_CLIENT_SUPPORT_LIVE_MIRROR_H_
