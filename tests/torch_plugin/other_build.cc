// A library with the id of another build.
#include "model/torch_plugin/torch_plugin.h"

extern "C" {
extern const duet::torch_plugin::Exported duet_torch_engine;
const duet::torch_plugin::Exported duet_torch_engine = {"another", {}};
}
