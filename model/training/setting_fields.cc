#include "model/training/setting_fields.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::training {

std::string OneOf(base::ObjectReader* reader, const std::string& key,
                  const std::vector<std::string>& choices) {
  constexpr std::size_t kMaxWord = 64;
  std::string value = reader->String(key, kMaxWord);
  if (reader->ok() && std::find(choices.begin(), choices.end(), value) == choices.end()) {
    reader->Fail(key, absl::StrCat("expected one of ", absl::StrJoin(choices, ", "), ", got ",
                                   base::Quoted(value)));
  }
  return value;
}

double Probability(base::ObjectReader* reader, const std::string& key) {
  return reader->Number(key, 0, 1);
}

std::string Text(double value) {
  const std::string text = nlohmann::json(value).dump();
  return std::string(absl::StripSuffix(text, ".0"));
}

std::string Text(bool value) { return value ? "true" : "false"; }

}  // namespace duet::training
