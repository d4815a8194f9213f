// SPDX-License-Identifier: Apache-2.0
#include "server/commands/log.h"

#include <string>

#include <gtest/gtest.h>

namespace {

using server::commands::escape_for_log;

TEST(Log, LeavesPlainTextAsItIs) {
  EXPECT_EQ(escape_for_log("GET /v1/sweeps 200 0.1 ms \\ \"~"), "GET /v1/sweeps 200 0.1 ms \\ \"~");
}

TEST(Log, KeepsTextOfUsersOnItsLine) {
  EXPECT_EQ(escape_for_log("a\r\n2026-01-01 info all is well"), "a\\x0d\\x0a2026-01-01 info all is well");
  EXPECT_EQ(escape_for_log("\x1b[2J\x7f\x9b\xc3\xa4"), "\\x1b[2J\\x7f\\x9b\\xc3\\xa4");
  EXPECT_EQ(escape_for_log(std::string(1, '\0')), "\\x00");
}

}  // namespace
