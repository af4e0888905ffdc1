#ifndef DUET_CLIENT_CAPTURE_BYTE_READER_H_
#define DUET_CLIENT_CAPTURE_BYTE_READER_H_

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "absl/strings/string_view.h"

namespace duet::client::capture {

// Reads numbers from the front of untrusted bytes. Reading beyond the end returns zeros and makes
// `ok` false from then on, so that callers check once.
class ByteReader {
 public:
  explicit ByteReader(absl::string_view bytes) : rest_(bytes) {}

  bool ok() const { return ok_; }
  absl::string_view rest() const { return rest_; }

  // The next `count` bytes; empty beyond the end.
  absl::string_view Bytes(std::size_t count) {
    if (count > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const absl::string_view bytes = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return bytes;
  }
  uint8_t Byte() { return static_cast<uint8_t>(BigEndian(1)); }
  uint16_t Big16() { return static_cast<uint16_t>(BigEndian(2)); }
  uint32_t Big32() { return static_cast<uint32_t>(BigEndian(4)); }
  uint64_t Big64() { return BigEndian(8); }
  float BigFloat() {
    const uint32_t bits = Big32();
    float value = 0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  double BigDouble() {
    const uint64_t bits = Big64();
    double value = 0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  uint16_t Little16() {
    const uint16_t low = Byte();
    return static_cast<uint16_t>(low | (Byte() << 8));
  }
  uint32_t Little32() {
    const uint32_t low = Little16();
    return low | (uint32_t{Little16()} << 16);
  }

 private:
  uint64_t BigEndian(std::size_t size) {
    uint64_t value = 0;
    for (const char byte : Bytes(size)) value = (value << 8) | static_cast<unsigned char>(byte);
    return value;
  }

  absl::string_view rest_;
  bool ok_ = true;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_BYTE_READER_H_
