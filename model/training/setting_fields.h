#ifndef DUET_MODEL_TRAINING_SETTING_FIELDS_H_
#define DUET_MODEL_TRAINING_SETTING_FIELDS_H_

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/base/strict_json.h"

namespace duet::training {

inline constexpr int64_t kMaxUnits = 4096;
inline constexpr int64_t kMaxEpochs = 1000000;
inline constexpr double kMaxWeight = 1e6;

// Settings by dotted path, with their values as text.
using Description = std::map<std::string, std::string>;

// The fields of a training configuration. Settings declare themselves once, for reading a
// configuration and for describing it:
//
//   fields->Section("drift", [&] {
//     fields->Share("share", &drift->share);
//     fields->Number("tilt", 0, 4, &drift->tilt);
//   });
class SettingFields {
 public:
  // Reads the values from a JSON object. Errors are recorded in `reader`.
  explicit SettingFields(base::ObjectReader* reader) : reader_(reader) {}
  // Adds the values to `description`, as the shortest texts that read back as the same values.
  explicit SettingFields(Description* description) : description_(description) {}

  // Whether there is a field of this name. Fields that configurations of earlier versions lack are
  // declared only if there is one.
  bool Has(const std::string& name) const { return reader_ == nullptr || reader_->Has(name); }
  void Number(const std::string& name, double min, double max, double* value);
  // A probability, or a part of a whole.
  void Share(const std::string& name, double* value) { Number(name, 0, 1, value); }
  void Int(const std::string& name, int64_t min, int64_t max, int64_t* value);
  void Bool(const std::string& name, bool* value);
  // One of several words.
  void Word(const std::string& name, const std::vector<std::string>& choices, std::string* value);
  void Words(const std::string& name, std::vector<std::string>* values);

  // Declares the fields of the object `name` with `declare()`.
  template <typename Declare>
  void Section(const std::string& name, Declare declare) {
    const std::string outer = path_;
    path_ += name + ".";
    if (reader_ == nullptr) {
      declare();
    } else if (const nlohmann::json& object = reader_->Object(name); reader_->ok()) {
      base::ObjectReader section(object, reader_->PathOf(name));
      base::ObjectReader* const reader = std::exchange(reader_, &section);
      declare();
      reader_ = reader;
      reader_->Update(section.Finish());
    }
    path_ = outer;
  }

 private:
  base::ObjectReader* reader_ = nullptr;  // of the current section
  Description* description_ = nullptr;
  std::string path_;  // of the current section, with a dot at its end
};

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_SETTING_FIELDS_H_
