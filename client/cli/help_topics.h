#ifndef DUET_CLIENT_CLI_HELP_TOPICS_H_
#define DUET_CLIENT_CLI_HELP_TOPICS_H_

#include <string>
#include <vector>

namespace duet::client::cli {

// The topics of duet help.
std::vector<std::string> HelpTopics();
std::string HelpTopicNames();  // "exit-codes, formats, ..."
// The text of a topic: a summary in one line, an empty line, and the rest.
std::string TopicText(const std::string& topic);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_HELP_TOPICS_H_
