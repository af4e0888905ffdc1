#ifndef DUET_MODEL_TORCH_PLUGIN_BUILD_ID_H_
#define DUET_MODEL_TORCH_PLUGIN_BUILD_ID_H_

namespace duet::torch_plugin {

// Identifies the build: versions, compilers and settings that can change the layout of classes.
inline constexpr char kBuildId[] = DUET_VERSION ", " __VERSION__
#ifdef NDEBUG
                                                ", release";
#else
                                                ", debug";
#endif

}  // namespace duet::torch_plugin

#endif  // DUET_MODEL_TORCH_PLUGIN_BUILD_ID_H_
