// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "jobs/base/flat_json.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

/// The list as FlatJson reads it; empty if it leaves it to others.
std::optional<json> read_list(const std::string& text) {
  jobs::FlatJson flat(text);
  if (!flat.open('[')) return std::nullopt;
  json list = json::array();
  for (json value; flat.next_value(value);) list.push_back(value);
  return flat.close(']') ? std::optional(list) : std::nullopt;
}

std::optional<json> read_object(const std::string& text) {
  jobs::FlatJson flat(text);
  if (!flat.open('{')) return std::nullopt;
  json object = json::object();
  for (std::string_view key; flat.next_key(key);) {
    const auto value = flat.value();
    if (!value) return std::nullopt;
    object[std::string(key)] = *value;
  }
  return flat.close('}') ? std::optional(object) : std::nullopt;
}

/// Equal values of equal types: 1 and 1.0 are not the same.
void expect_same(const std::optional<json>& read, const std::string& text) {
  ASSERT_TRUE(read.has_value()) << text;
  EXPECT_EQ(read->dump(), json::parse(text).dump());
}

RC_GTEST_PROP(FlatJson, ReadsTheNumbersThatWereWritten,
              (const std::vector<std::int64_t>& bits, const std::vector<std::int64_t>& integers)) {
  json list = integers;
  for (const std::int64_t b : bits) {
    const double x = std::bit_cast<double>(b * 0x9e3779b97f4a7c15L);
    if (std::isfinite(x)) list.push_back(x);
  }
  const auto read = read_list(list.dump());
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->dump() == list.dump());
  RC_ASSERT(*read == json::parse(list.dump()));
}

TEST(FlatJson, ReadsEveryKindOfValue) {
  for (const std::string text :
       {R"([])", R"([0])", R"([-0.0,0.0,1e300,-1e-5,18446744073709551615,-9223372036854775808])",
        R"(["rigid",null,true,false,1.5])"}) {
    expect_same(read_list(text), text);
  }
  for (const std::string text : {R"({})", R"({"a":1,"b":null,"c":"x y","d":2.5e-7})"})
    expect_same(read_object(text), text);
}

TEST(FlatJson, LeavesEverythingElseToOthers) {
  for (const std::string text : {"",
                                 "[",
                                 "[1",
                                 "[1,",
                                 "[1,]",
                                 "[,1]",
                                 "[1 ]",
                                 "[ 1]",
                                 "[1]]",
                                 "[[1]]",
                                 "[{}]",
                                 "[01]",
                                 "[.5]",
                                 "[5.]",
                                 "[+1]",
                                 "[1e]",
                                 "[-]",
                                 "[--1]",
                                 "[nan]",
                                 "[NaN]",
                                 "[inf]",
                                 "[1e999]",
                                 "[18446744073709551616]",
                                 "[\"a\\n\"]",
                                 "[\"\xc3\xa9\"]",
                                 "[\"a]",
                                 "[nul]",
                                 "{}"}) {
    EXPECT_FALSE(read_list(text).has_value()) << text;
  }
  for (const std::string text : {"", "{", "{\"a\"}", "{\"a\":}", "{\"a\":1,}", "{a:1}", "{\"a\":1}x",
                                 "{\"a\":{}}", "{\"a\":1 }", "[]"}) {
    EXPECT_FALSE(read_object(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace jobs_tests
