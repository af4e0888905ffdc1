// docs/settings.md lists every setting. With DUET_WRITE_DOCUMENTS set, the test writes it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "model/base/file.h"
#include "server/config/settings.h"
#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

constexpr char kIntroduction[] = R"(# Settings of duet-server

This page is generated from the options of [server_config.proto](../proto/duet/v1/server_config.proto), which
also has the details of each setting. To write it again:
`DUET_WRITE_DOCUMENTS=1 ctest --preset release -R '^server_config_test$'`.

Every setting is a flag, an environment variable (`DUET_SERVER_` and the flag's name, such as
`DUET_SERVER_MAX_CALLS` for `--max-calls`) and a field of the configuration file (`max_calls`). Flags override
variables, variables override the file. `duet-server --print-config` prints every value and its source.

| flag | value | default | range | what |
|---|---|---|---|---|
)";

std::string Cell(const std::string& text) {
  return absl::StrReplaceAll(text, {{"|", "\\|"}, {"<", "&lt;"}, {"*", "\\*"}});
}

std::string Document() {
  std::string text = kIntroduction;
  for (const Setting& setting : AllSettings()) {
    const bool is_value = !setting.options().default_value().empty();
    const std::string quote = is_value ? "`" : "";
    absl::StrAppend(&text, "| `--", setting.flag(), "` | ", Cell(setting.unit()), " | ", quote,
                    is_value ? setting.default_text() : Cell(setting.default_text()), quote, " | ",
                    setting.range_text(), " | ", Cell(setting.options().help()), " |\n");
  }
  return text;
}

TEST(SettingsDocumentTest, AgreesWithTheSchema) {
  const char* const source = std::getenv("DUET_SOURCE_DIR");
  ASSERT_NE(source, nullptr) << "set by ctest";
  const std::filesystem::path path = std::filesystem::path(source) / "docs" / "settings.md";
  if (std::getenv("DUET_WRITE_DOCUMENTS") != nullptr) std::ofstream(path) << Document();
  const absl::StatusOr<std::string> written =
      base::ReadFile(path, std::size_t{1} << 20, "a document");
  ASSERT_THAT(written, IsOk());
  EXPECT_EQ(*written, Document()) << "see the top of docs/settings.md";
}

}  // namespace
}  // namespace duet::server::config
