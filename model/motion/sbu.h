#ifndef DUET_MODEL_MOTION_SBU_H_
#define DUET_MODEL_MOTION_SBU_H_

namespace duet::motion {

// The frame rate of the SBU Kinect Interaction captures, whose text files do not state it.
inline constexpr double kSbuFrameRateHz = 15;

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_SBU_H_
