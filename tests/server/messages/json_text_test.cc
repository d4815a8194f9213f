// SPDX-License-Identifier: Apache-2.0
#include "server/messages/json_text.h"

#include <cstdlib>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace {

using server::BadJson;
using server::parse_json;

std::string message_of(const std::string& text) {
  try {
    static_cast<void>(parse_json(text));
  } catch (const BadJson& error) {
    return error.what();
  }
  return "accepted";
}

std::string nested(std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); }

TEST(ParseJson, KeepsTheOrderOfKeys) {
  const auto value = parse_json(R"({"b": 1, "a": 2, "c": 3})");
  std::string order;
  for (const auto& [key, unused] : value.items()) order += key;
  EXPECT_EQ(order, "bac");
}

TEST(ParseJson, NamesTheByteWhereJsonEnds) {
  // The brace is the sixth byte.
  EXPECT_EQ(message_of(R"({"a":})").substr(0, 21), "not JSON at byte 6: p");
  EXPECT_NE(message_of("").find("empty"), std::string::npos);
}

TEST(ParseJson, RefusesAKeyThatStandsTwice) {
  EXPECT_NE(message_of(R"({"a": 1, "b": {"a": 1}, "a": 2})").find("\"a\" stands twice"), std::string::npos);
  EXPECT_EQ(message_of(R"([{"a": 1}, {"a": 2}, {"b": {"a": 1}, "a": 1}])"), "accepted");
}

TEST(ParseJson, RefusesDepthBeforeItReachesTheStack) {
  EXPECT_EQ(message_of(nested(server::kMaxJsonDepth)), "accepted");
  EXPECT_NE(message_of(nested(server::kMaxJsonDepth + 1)).find("nested deeper"), std::string::npos);
  // Unfinished, so that only the bound on depth can be what ends it.
  EXPECT_NE(message_of(std::string(4'000'000, '[')).find("nested deeper"), std::string::npos);
}

TEST(ParseJson, RefusesAnObjectOfTooManyKeys) {
  std::string text = "{";
  for (std::size_t i = 0; i < server::kMaxObjectKeys; ++i) text += "\"" + std::to_string(i) + "\":1,";
  EXPECT_EQ(message_of(text + "\"nested\":{}}").find("more than 1024"), 0U);
  EXPECT_EQ(message_of(text.substr(0, text.size() - 1) + "}"), "accepted");
}

// Were each object to look at those before it, this would take hours.
TEST(ParseJson, ReadsALongListOfObjects) {
  constexpr std::size_t kObjects = 1'000'000;
  std::string text = "[{}";
  for (std::size_t i = 1; i < kObjects; ++i) text += ",{}";
  EXPECT_EQ(server::parse_json(text + "]", kObjects + 1).size(), kObjects);
}

TEST(ParseJson, RefusesANumberThatNoDoubleHolds) { EXPECT_NE(message_of("[1e999]"), "accepted"); }

TEST(ParseJson, ReadsWordsForWhatIsNoNumberAsNull) {
  const auto value = parse_json(R"({"a": NaN, "b": [-Infinity, Infinity], "c": "NaN \" Infinity"})");
  EXPECT_EQ(server::to_text(value), R"({"a":null,"b":[null,null],"c":"NaN \" Infinity"})");
  EXPECT_NE(message_of("[Nan]"), "accepted");
}

// The faulty byte is the last one, and words before it have other lengths than null.
TEST(ParseJson, NamesTheByteBehindWordsForWhatIsNoNumber) {
  for (const std::string text : {"[NaN, }", "[NaN, NaN, -NaN, }", "[Infinity, -Infinity, }", "[Infinity, NaN, }"}) {
    const std::string start = "not JSON at byte " + std::to_string(text.size()) + ": ";
    EXPECT_EQ(message_of(text).substr(0, start.size()), start) << message_of(text);
  }
}

TEST(ParseJson, RefusesANulWhereverItStands) {
  EXPECT_EQ(message_of(std::string("{}\0 and more", 12)), "not JSON at byte 3: a NUL character");
  EXPECT_NE(message_of(std::string("[\"\0\"]", 5)), "accepted");
}

TEST(ParseJson, RefusesBytesThatAreNoUtf8) { EXPECT_NE(message_of("\"\xff\""), "accepted"); }

TEST(ParseJson, BoundsTheValuesBeforeItKeepsThem) {
  std::string text = "[";
  for (std::size_t i = 0; i < server::kMaxJsonValues; ++i) text += "1,";
  text.back() = ']';
  EXPECT_THROW(static_cast<void>(server::parse_json(text)), server::BadJson);  // with the list itself, one more
  EXPECT_NO_THROW(static_cast<void>(server::parse_json(text, server::kMaxJsonValues + 1)));
  for (const char* const value : {"\"\"", "null", "true", "1.5", "-1", "[]", "{}"}) {
    const std::string two = std::string("[") + value + "," + value + "]";
    EXPECT_NO_THROW(static_cast<void>(server::parse_json(two, 3))) << value;
    EXPECT_THROW(static_cast<void>(server::parse_json(two, 2)), server::BadJson) << value;
  }
}

}  // namespace
