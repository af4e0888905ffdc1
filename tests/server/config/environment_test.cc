#include "server/config/environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

TEST(EnvironmentTest, HasTheServersVariables) {
  const char* variables[] = {"DUET_SERVER=lab:1",      "DUET_SERVER_MAX_CALLS=4", "PATH=/bin",
                             "DUET_SERVER_LISTEN=a=b", "DUET_SERVER_EMPTY=",      nullptr};
  EXPECT_THAT(ReadEnvironment(variables),
              ElementsAre(Pair("DUET_SERVER_EMPTY", ""), Pair("DUET_SERVER_LISTEN", "a=b"),
                          Pair("DUET_SERVER_MAX_CALLS", "4")));
}

TEST(EnvironmentTest, IgnoresVariablesThatKubernetesSetsForServices) {
  const char* variables[] = {
      "DUET_SERVER_SERVICE_HOST=10.0.0.1",        "DUET_SERVER_SERVICE_PORT=50051",
      "DUET_SERVER_SERVICE_PORT_GRPC=50051",      "DUET_SERVER_PORT=tcp://10.0.0.1:50051",
      "DUET_SERVER_PORT_50051_TCP_ADDR=10.0.0.1", nullptr};
  EXPECT_THAT(ReadEnvironment(variables), ElementsAre());
}

TEST(EnvironmentTest, VariablesAndFlagsHaveOneName) {
  EXPECT_EQ(FlagOfVariable("DUET_SERVER_MAX_CALLS"), "--max-calls");
  EXPECT_EQ(VariableOfFlag("max-calls"), "DUET_SERVER_MAX_CALLS");
}

}  // namespace
}  // namespace duet::server::config
