// SPDX-License-Identifier: Apache-2.0
#include "server/http/access.h"

#include <string>

#include <gtest/gtest.h>

namespace {

using server::AccessCheck;

constexpr const char* kToken = "correct-horse-battery";

TEST(Access, IsEverybodysWithoutAToken) { EXPECT_TRUE(AccessCheck("").is_allowed("/v1/sweeps", "")); }

struct AuthorizationCase {
  std::string name;
  std::string authorization;
  bool good;
};

class Authorization : public testing::TestWithParam<AuthorizationCase> {};

TEST_P(Authorization, IsJudged) {
  const AccessCheck check(kToken);
  for (const char* const path : {"/v1/sweeps", "/metrics", "/", "/healthz/", "/nothing"}) {
    EXPECT_EQ(check.is_allowed(path, GetParam().authorization), GetParam().good) << path;
  }
  // Whether it is up is told to everybody.
  for (const char* const path : {"/healthz", "/readyz"})
    EXPECT_TRUE(check.is_allowed(path, GetParam().authorization)) << path;
}

// The base64 texts are those of `printf %s lab:correct-horse-battery | base64` and the like.
INSTANTIATE_TEST_SUITE_P(
    Kinds, Authorization,
    testing::Values(AuthorizationCase{"Bearer", "Bearer correct-horse-battery", true},
                    AuthorizationCase{"SchemeInCapitals", "BEARER  correct-horse-battery", true},
                    AuthorizationCase{"Password", "Basic bGFiOmNvcnJlY3QtaG9yc2UtYmF0dGVyeQ==", true},
                    AuthorizationCase{"PasswordWithoutAName", "basic OmNvcnJlY3QtaG9yc2UtYmF0dGVyeQ==", true},
                    AuthorizationCase{"Nothing", "", false},
                    AuthorizationCase{"NoScheme", "correct-horse-battery", false},
                    AuthorizationCase{"OtherScheme", "Digest correct-horse-battery", false},
                    AuthorizationCase{"EmptyBearer", "Bearer ", false},
                    AuthorizationCase{"Wrong", "Bearer correct-horse-batterz", false},
                    AuthorizationCase{"BeginsLikeIt", "Bearer correct-horse-batter", false},
                    AuthorizationCase{"GoesOnAfterIt", "Bearer correct-horse-battery1", false},
                    AuthorizationCase{"AsTheName", "Basic Y29ycmVjdC1ob3JzZS1iYXR0ZXJ5Og==", false},
                    AuthorizationCase{"PasswordNotEncoded", "Basic lab:correct-horse-battery", false},
                    AuthorizationCase{"NoBase64", "Basic ====", false}),
    [](const auto& case_info) { return case_info.param.name; });

TEST(Token, HasToBeLongAndPlain) {
  EXPECT_EQ(server::describe_token_fault(kToken), "");
  EXPECT_EQ(server::describe_token_fault(std::string(16, 'a')), "");
  for (const std::string& token :
       {std::string(), std::string(15, 'a'), std::string(513, 'a'), std::string("correct horse battery"),
        std::string("correct-horse-\nbattery"), std::string("correct-horse-\xc3\xa4-battery")}) {
    EXPECT_NE(server::describe_token_fault(token), "") << token;
  }
}

}  // namespace
