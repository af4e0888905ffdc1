#include "model/training/named_configs.h"

#include <cstddef>

#include "model/training/named_configs.inc"
