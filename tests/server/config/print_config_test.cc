#include "server/config/print_config.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "server/config/load_config.h"
#include "tests/support/status_matchers.h"

namespace duet::server::config {
namespace {

using test::IsOk;

using ::testing::HasSubstr;

TEST(PrintConfigTest, TellsEveryValueAndWhereItComesFrom) {
  v1::ServerConfig config;
  config.set_max_calls(64);
  for (const int version : {3, 4}) {
    v1::VersionLabel& label = *config.add_version_labels();
    label.set_model("sbu");
    label.set_label(absl::StrCat("v", version));
    label.set_version(static_cast<uint32_t>(version));
  }
  const absl::StatusOr<ServerOptions> options = ToOptions(config, 2);
  ASSERT_THAT(options, IsOk());
  const std::string text =
      PrintConfig(*options, {{"max_calls", "file a:3:1"}, {"version_labels[1]", "command line"}});
  EXPECT_THAT(text, HasSubstr("\nmax_calls: 64  # file a:3:1\n"));
  EXPECT_THAT(text, HasSubstr("\nworkers: 2  # default\n"));
  EXPECT_THAT(text, HasSubstr("\nversion_labels { model: \"sbu\" label: \"v4\" version: 4 }  # "
                              "command line\n"));
}

TEST(PrintConfigTest, CanBeReadAgain) {
  v1::ServerConfig config;
  config.set_engine(v1::ENGINE_TORCH);
  config.set_precision(v1::PRECISION_F32);
  config.set_clean_up(v1::CLEAN_UP_POLICY_OFF);
  config.set_metrics_listen("off");
  const absl::StatusOr<ServerOptions> options = ToOptions(config, 2);
  ASSERT_THAT(options, IsOk());
  const absl::StatusOr<v1::ServerConfig> again =
      ParseConfigText(PrintConfig(*options, {}), /*json=*/false);
  ASSERT_THAT(again, IsOk());
  const absl::StatusOr<ServerOptions> same = ToOptions(*again, 7);
  ASSERT_THAT(same, IsOk());
  EXPECT_TRUE(
      google::protobuf::util::MessageDifferencer::Equals(ToConfig(*same), ToConfig(*options)));
}

TEST(PrintConfigTest, LeavesNoFieldOut) {
  const v1::ServerConfig config = ToConfig(ServerOptions());
  for (int i = 0; i < config.GetDescriptor()->field_count(); ++i) {
    const google::protobuf::FieldDescriptor* field = config.GetDescriptor()->field(i);
    // An absent file or name is left out.
    const bool is_text = field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_STRING;
    if (field->is_repeated() || is_text) continue;
    EXPECT_TRUE(config.GetReflection()->HasField(config, field)) << field->name();
  }
}

}  // namespace
}  // namespace duet::server::config
