#ifndef DUET_CLIENT_CLI_HELP_TOPICS_H_
#define DUET_CLIENT_CLI_HELP_TOPICS_H_

#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// What duet help explains besides commands.
std::vector<std::string> HelpTopics();
std::string HelpTopicNames();  // "exit-codes, formats, ..."
// The text of one of them: a line that says what it is about, and the rest.
std::string TopicText(const std::string& topic);

// What a command or a topic is about; of all commands for an empty one. A usage error for a name
// that is neither.
ParsedCommandLine ExplainTopic(const CLI::App& app, const std::string& topic);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_HELP_TOPICS_H_
