#include "client/cli/batch_servers.h"

#include <iostream>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::cli {
namespace {

// The options of every client that duet batch makes with these arguments.
std::vector<ClientOptions> OptionsOf(const BatchArguments& arguments) {
  std::vector<ClientOptions> asked;
  ProgramEnvironment environment{[&asked](const ClientOptions& options) {
                                   asked.push_back(options);
                                   return Client::Create(options);
                                 },
                                 &std::cout, &std::cerr};
  EXPECT_THAT(Connect(arguments, environment), IsOk());
  return asked;
}

// The flow of the batch repeats calls itself, and decides how many run at a time.
TEST(BatchServersTest, ClientsDoNotRetry) {
  BatchArguments arguments;
  arguments.servers = {"localhost:1", "localhost:2"};
  const std::vector<ClientOptions> options = OptionsOf(arguments);
  ASSERT_THAT(options, SizeIs(2));
  EXPECT_EQ(options[0].server_address, "localhost:1");
  EXPECT_EQ(options[1].server_address, "localhost:2");
  for (const ClientOptions& one : options) EXPECT_EQ(one.retry.max_attempts, 1);
}

TEST(BatchServersTest, SeveralChannelsHaveConnectionsOfTheirOwn) {
  BatchArguments arguments;
  arguments.servers = {"localhost:1"};
  EXPECT_FALSE(OptionsOf(arguments).at(0).own_connection);
  arguments.channels = 2;
  const std::vector<ClientOptions> options = OptionsOf(arguments);
  ASSERT_THAT(options, SizeIs(2));
  EXPECT_TRUE(options[0].own_connection);
  EXPECT_TRUE(options[1].own_connection);
}

}  // namespace
}  // namespace duet::client::cli
