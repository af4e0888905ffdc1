#ifndef DUET_MODEL_BASE_DESCRIPTOR_H_
#define DUET_MODEL_BASE_DESCRIPTOR_H_

#include <unistd.h>

namespace duet::base {

// Owns a file descriptor and closes it.
class Descriptor {
 public:
  // `value` is what open() returned; negative means that there is no descriptor.
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
