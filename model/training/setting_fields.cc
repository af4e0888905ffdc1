#include "model/training/setting_fields.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::training {
namespace {

constexpr std::size_t kMaxWords = 256, kMaxWordBytes = 64;

}  // namespace

void SettingFields::Number(const std::string& name, double min, double max, double* value) {
  if (reader_ != nullptr) {
    *value = reader_->Number(name, min, max);
  } else {
    const std::string text = nlohmann::json(*value).dump();
    (*description_)[path_ + name] = std::string(absl::StripSuffix(text, ".0"));
  }
}

void SettingFields::Int(const std::string& name, int64_t min, int64_t max, int64_t* value) {
  if (reader_ != nullptr) {
    *value = reader_->Int(name, min, max);
  } else {
    (*description_)[path_ + name] = absl::StrCat(*value);
  }
}

void SettingFields::Bool(const std::string& name, bool* value) {
  if (reader_ != nullptr) {
    *value = reader_->Bool(name);
  } else {
    (*description_)[path_ + name] = *value ? "true" : "false";
  }
}

void SettingFields::Word(const std::string& name, const std::vector<std::string>& choices,
                         std::string* value) {
  if (reader_ == nullptr) {
    (*description_)[path_ + name] = *value;
    return;
  }
  *value = reader_->String(name, kMaxWordBytes);
  if (reader_->ok() && std::find(choices.begin(), choices.end(), *value) == choices.end()) {
    reader_->Fail(name, absl::StrCat("expected one of ", absl::StrJoin(choices, ", "), ", got ",
                                     base::Quoted(*value)));
  }
}

void SettingFields::Words(const std::string& name, std::vector<std::string>* values) {
  if (reader_ != nullptr) {
    *values = reader_->Strings(name, kMaxWords);
  } else {
    (*description_)[path_ + name] = absl::StrJoin(*values, " ");
  }
}

}  // namespace duet::training
