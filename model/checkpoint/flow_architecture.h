#ifndef DUET_MODEL_CHECKPOINT_FLOW_ARCHITECTURE_H_
#define DUET_MODEL_CHECKPOINT_FLOW_ARCHITECTURE_H_

namespace duet::checkpoint {

// Sizes and numbers of the sampling generator: a transformer over the whole window, trained by
// conditional flow matching. All else follows from skeleton and classes.
struct FlowArchitecture {
  int width = 160;
  int blocks = 4;
  int heads = 4;  // divides the width
  int feed_forward = 480;
  int reach = 50;  // frames, the farthest that attention tells apart by distance

  // One unit of the network's output, metres: it answers with offsets from a base pose.
  double offset_scale = 0.2;

  // What sampling starts from: offsets like those of the training followers, smooth in time.
  struct Noise {
    double frame_length = 4;      // of the squared exponential kernel over the frames
    double constant_share = 0.6;  // of the variance, one value a clip; with no start told
    int ramp_frames = 8;          // after the last known frame until the full deviation
    double white = 0.02;          // deviation of what each frame has of its own
  } noise;

  int steps = 3;          // Euler steps from noise to motion
  double guidance = 1.5;  // multiplies the label weights above 0
  int fade_frames = 5;    // over which the last known frame's correction fades out
};

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_FLOW_ARCHITECTURE_H_
