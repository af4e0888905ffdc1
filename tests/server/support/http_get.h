#ifndef DUET_TESTS_SERVER_SUPPORT_HTTP_GET_H_
#define DUET_TESTS_SERVER_SUPPORT_HTTP_GET_H_

#include <string>

namespace duet::test {

// Sends bytes to a port of this machine and returns everything received until the connection
// closes. Shares no code with the server's HTTP.
std::string Exchange(int port, const std::string& request);

// Returns the whole HTTP response to a GET, headers and body.
std::string HttpGet(int port, const std::string& path);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_HTTP_GET_H_
