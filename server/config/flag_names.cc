#include "server/config/flag_names.h"

#include <algorithm>

namespace duet::server::config {
namespace {

std::string InKebabCase(const CLI::App& app, const std::string& argument) {
  if (argument.rfind("--", 0) != 0) return argument;
  const std::size_t end = std::min(argument.find('='), argument.size());
  std::string name = argument.substr(0, end);
  std::replace(name.begin(), name.end(), '_', '-');
  if (app.get_option_no_throw(name) == nullptr) return argument;
  return name + argument.substr(end);
}

}  // namespace

std::vector<std::string> ArgumentsInKebabCase(const CLI::App& app, int argc,
                                              const char* const* argv) {
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) arguments.push_back(InKebabCase(app, argv[i]));
  return arguments;
}

}  // namespace duet::server::config
