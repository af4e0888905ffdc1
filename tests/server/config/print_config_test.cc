#include "server/config/print_config.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "server/config/load_config.h"
#include "server/config/setting.h"
#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

TEST(PrintConfigTest, PrintsEveryValueWithItsSource) {
  v1::ServerConfig config;
  config.set_max_calls(64);
  for (const int version : {3, 4}) {
    v1::VersionLabel& label = *config.add_version_labels();
    label.set_model("sbu");
    label.set_label(absl::StrCat("v", version));
    label.set_version(static_cast<uint32_t>(version));
  }
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(config, 2);
  ASSERT_THAT(options, IsOk());
  const std::string text =
      PrintConfig(*options, {{"max_calls", "file a:3:1"}, {"version_labels[1]", "command line"}});
  EXPECT_THAT(text, HasSubstr("\nmax_calls: 64  # file a:3:1\n"));
  EXPECT_THAT(text, HasSubstr("\nworkers: 2  # default\n"));
  EXPECT_THAT(text, HasSubstr("\nversion_labels { model: \"sbu\" label: \"v4\" version: 4 }  # "
                              "command line\n"));
}

TEST(PrintConfigTest, PrintsAConfigurationFileWithTheSameSettings) {
  v1::ServerConfig config;
  config.set_engine(v1::ENGINE_TORCH);
  config.set_precision(v1::PRECISION_F32);
  config.set_clean_up(v1::CLEAN_UP_POLICY_OFF);
  config.set_metrics_listen("off");
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(config, 2);
  ASSERT_THAT(options, IsOk());
  const absl::StatusOr<v1::ServerConfig> again =
      ParseConfigText(PrintConfig(*options, {}), /*json=*/false);
  ASSERT_THAT(again, IsOk());
  const absl::StatusOr<v1::ServerConfig> same = ResolveSettings(*again, 7);
  ASSERT_THAT(same, IsOk());
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(*same, *options));
}

TEST(PrintConfigTest, PrintsEveryField) {
  const std::string text = PrintConfig(ReadSettings(v1::ServerConfig(), 2).values, {});
  for (const Setting& setting : AllSettings()) {
    EXPECT_THAT(text, AnyOf(HasSubstr("# " + setting.name() + " is not set\n"),
                            HasSubstr(setting.name() + ": ")));
  }
}

}  // namespace
}  // namespace duet::server::config
