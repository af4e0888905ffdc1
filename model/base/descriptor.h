#ifndef DUET_MODEL_BASE_DESCRIPTOR_H_
#define DUET_MODEL_BASE_DESCRIPTOR_H_

#include <unistd.h>

namespace duet::base {

// A file descriptor that closes itself.
class Descriptor {
 public:
  // `value` as open() returns it: negative where there is none.
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }

  int get() const { return value_; }
  bool ok() const { return value_ >= 0; }

 private:
  int value_;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_DESCRIPTOR_H_
