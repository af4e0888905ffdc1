#ifndef DUET_MODEL_BASE_FLAG_NAMES_H_
#define DUET_MODEL_BASE_FLAG_NAMES_H_

#include <string>
#include <vector>

namespace duet::base {

// The command line with its flags in kebab-case: "--some_flag" and "--some_flag=x_y" become
// "--some-flag" and "--some-flag=x_y". A program that declares its flags in kebab-case thereby also
// accepts snake_case, without listing it in its help.
//
// Unchanged: the program's name, arguments that do not begin with "--", the value after "=", and
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
  // argc() strings and a null pointer, as for main(). Valid while this object lives.
  const char* const* argv() const { return pointers_.data(); }

 private:
  std::vector<std::string> words_;
  std::vector<const char*> pointers_;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_FLAG_NAMES_H_
