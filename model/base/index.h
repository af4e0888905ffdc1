#ifndef DUET_MODEL_BASE_INDEX_H_
#define DUET_MODEL_BASE_INDEX_H_

#include <cstddef>

namespace duet::base {

// A joint or another number of at least 0, as an index of a container.
inline std::size_t Index(int number) { return static_cast<std::size_t>(number); }

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_INDEX_H_
