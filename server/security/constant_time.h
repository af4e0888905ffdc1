#ifndef DUET_SERVER_SECURITY_CONSTANT_TIME_H_
#define DUET_SERVER_SECURITY_CONSTANT_TIME_H_

#include <cstddef>
#include <string_view>

namespace duet::server::security {

// Compares two texts in a time that depends only on their lengths. A time that revealed the number
// of correct characters would let an attacker find a secret character by character.
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
