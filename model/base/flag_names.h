#ifndef DUET_MODEL_BASE_FLAG_NAMES_H_
#define DUET_MODEL_BASE_FLAG_NAMES_H_

#include <string>
#include <vector>

namespace duet::base {

// A command line whose flags are spelt in kebab-case: what main() was given, with "--some_flag" and
// "--some_flag=x_y" as "--some-flag" and "--some-flag=x_y". A program that declares its flags in
// kebab-case so takes their older names in snake_case too, without showing them in its help.
//
// Left as they are: the program's name, words that do not begin with "--", what follows a "=", and
// everything after a bare "--".
//
//   const base::KebabCaseCommandLine line(argc, argv);
//   app.parse(line.argc(), line.argv());
class KebabCaseCommandLine {
 public:
  KebabCaseCommandLine(int argc, const char* const* argv);
  KebabCaseCommandLine(const KebabCaseCommandLine&) = delete;
  KebabCaseCommandLine& operator=(const KebabCaseCommandLine&) = delete;

  int argc() const { return static_cast<int>(words_.size()); }
  // argc() words and a null pointer, as main() has them; valid while this object lives.
  const char* const* argv() const { return pointers_.data(); }

 private:
  std::vector<std::string> words_;
  std::vector<const char*> pointers_;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_FLAG_NAMES_H_
