#include "model/embedded/embedded.h"

#include <cstddef>

#define DUET_BYTES(symbol) \
  { symbol, static_cast<std::size_t>(symbol##_end - symbol) }
#include "model/embedded/embedded.inc"
