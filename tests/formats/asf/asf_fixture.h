#ifndef DUET_TESTS_FORMATS_ASF_ASF_FIXTURE_H_
#define DUET_TESTS_FORMATS_ASF_ASF_FIXTURE_H_

#include <string>

#include "model/motion/clip.h"

namespace duet::test {

// A person as Acclaim's pair of files, in CMU's unit; each bone has axes of its own.
struct AsfFiles {
  std::string asf;
  std::string amc;
};
AsfFiles MakeAsfFiles(const motion::Clip& clip);

}  // namespace duet::test

#endif  // DUET_TESTS_FORMATS_ASF_ASF_FIXTURE_H_
