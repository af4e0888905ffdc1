#ifndef DUET_SERVER_SECURITY_CONSTANT_TIME_H_
#define DUET_SERVER_SECURITY_CONSTANT_TIME_H_

#include <cstddef>
#include <string_view>

namespace duet::server::security {

// Whether two texts are equal, in a time that depends on their lengths alone: a time that told how
// many characters were right would let a secret be found one character after the other.
inline bool EqualInConstantTime(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  }
  return difference == 0;
}

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_CONSTANT_TIME_H_
