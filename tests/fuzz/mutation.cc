#include "tests/fuzz/mutation.h"

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "absl/strings/ascii.h"

namespace duet::fuzz {
namespace {

constexpr const char* kNumbers[] = {"0",     "-1",         "1e38", "-1e-300",
                                    "nan",   "4294967296", "",     "9223372036854775807",
                                    "1e999", "0.5",        "1024", "2147483647"};
constexpr int kMostChanges = 4;
constexpr int kLongestStretch = 64;

std::size_t Place(std::size_t size, base::Random& random) {
  return size == 0 ? 0 : static_cast<std::size_t>(random.Below(static_cast<int64_t>(size)));
}

// A stretch of a text, perhaps empty.
absl::string_view Stretch(absl::string_view text, base::Random& random) {
  const std::size_t length = 1 + Place(kLongestStretch, random);
  return text.substr(Place(text.size(), random), length);
}

// Puts another number where the first one after a random place stands.
void ReplaceNumber(std::string* text, base::Random& random) {
  std::size_t begin = Place(text->size(), random);
  while (begin < text->size() && !absl::ascii_isdigit(static_cast<unsigned char>((*text)[begin]))) {
    ++begin;
  }
  std::size_t end = begin;
  while (end < text->size() && absl::ascii_isdigit(static_cast<unsigned char>((*text)[end]))) ++end;
  text->replace(begin, end - begin, kNumbers[Place(std::size(kNumbers), random)]);
}

void Change(std::string* text, absl::string_view other, base::Random& random) {
  const std::size_t place = Place(text->size(), random);
  switch (random.Below(6)) {
    case 0:
      if (!text->empty()) (*text)[place] ^= static_cast<char>(1 << random.Below(8));
      break;
    case 1:
      if (!text->empty()) (*text)[place] = static_cast<char>(random.Below(256));
      break;
    case 2:
      text->erase(place, 1 + Place(kLongestStretch, random));
      break;
    case 3:
      text->insert(place, std::string(Stretch(*text, random)));
      break;
    case 4:
      text->insert(place, std::string(Stretch(other, random)));
      break;
    default:
      ReplaceNumber(text, random);
  }
}

}  // namespace

std::string Mutated(absl::string_view input, absl::string_view other, base::Random& random) {
  std::string text(input);
  const int64_t changes = 1 + random.Below(kMostChanges);
  for (int64_t i = 0; i < changes; ++i) Change(&text, other, random);
  return text;
}

}  // namespace duet::fuzz
