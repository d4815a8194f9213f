// SPDX-License-Identifier: Apache-2.0
#include "server/messages/terminal_text.h"

#include <string>

#include <gtest/gtest.h>

namespace {

using server::LineEnds;
using server::terminal_text;

TEST(TerminalText, LeavesTextOfAllScripts) {
  for (const std::string text : {"run 7 \\ \"~", "Prüfstand ½", "試験", "\xf0\x9f\x94\xa9", "नमस्\u200dते", ""}) EXPECT_EQ(terminal_text(text), text);
}

TEST(TerminalText, ShowsControlCharactersAsText) {
  EXPECT_EQ(terminal_text("run 7\x1b]0;owned\x07\x1b[2K\rswp_0\n\tx\x7f"), "run 7\\x1b]0;owned\\x07\\x1b[2K\\x0dswp_0\\x0a\\x09x\\x7f");
  EXPECT_EQ(terminal_text(std::string(1, '\0')), "\\x00");
  EXPECT_EQ(terminal_text("a\u009b2Jb\u0085c"), "a\\u{009b}2Jb\\u{0085}c");
  EXPECT_EQ(terminal_text("\u202eevil\u2066\u2028\u200f\ufeff"), "\\u{202e}evil\\u{2066}\\u{2028}\\u{200f}\\u{feff}");
}

// A terminal that is not set to UTF-8 obeys 0x9b as ESC [.
TEST(TerminalText, ShowsBytesThatAreNoText) {
  EXPECT_EQ(terminal_text("\x9b"
                          "2J\xff\xc3"),
            "\\x9b2J\\xff\\xc3");
  EXPECT_EQ(terminal_text("\xc0\x9b"), "\\xc0\\x9b") << "overlong";
  EXPECT_EQ(terminal_text("\xe0\x80\x9b"), "\\xe0\\x80\\x9b") << "overlong";
  EXPECT_EQ(terminal_text("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(terminal_text("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(TerminalText, KeepsTheLinesOfATable) {
  EXPECT_EQ(terminal_text("a\tb\r\nc\x1b\n", LineEnds::kKept), "a\tb\\x0d\nc\\x1b\n");
}

}  // namespace
