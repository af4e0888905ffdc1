#ifndef DUET_MODEL_FORMATS_FBX_FBX_EXIT_H_
#define DUET_MODEL_FORMATS_FBX_FBX_EXIT_H_

// What duet-fbx and the library that runs it agree on.

namespace duet::formats::fbx {

// Statuses of the process. Others, and signals, are failures of assimp. A sanitizer's is 1.
inline constexpr int kConverted = 0;
inline constexpr int kWrongUse = 2;
inline constexpr int kRefused = 3;  // the output is a message

inline constexpr int kMostProcessorSeconds = 60;

}  // namespace duet::formats::fbx

#endif  // DUET_MODEL_FORMATS_FBX_FBX_EXIT_H_
