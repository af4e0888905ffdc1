// What libFuzzer calls. Built once for each target: DUET_FUZZ_TARGET is its function,
// DUET_FUZZ_HEADER declares it.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include DUET_FUZZ_HEADER

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const duet::fuzz::Broken broken =
      duet::fuzz::DUET_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  if (broken.empty()) return 0;
  std::fprintf(stderr, "broken promise: %s\n", broken.c_str());
  std::abort();
}
