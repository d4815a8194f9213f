// SPDX-License-Identifier: Apache-2.0
#include "server/messages/accept.h"

#include <string>

#include <gtest/gtest.h>

namespace {

struct CodingCase {
  std::string name;
  std::string accept_encoding;
  bool gzip;
};
void PrintTo(const CodingCase& c, std::ostream* out) { *out << c.name; }

class AcceptEncoding : public testing::TestWithParam<CodingCase> {};

TEST_P(AcceptEncoding, ChoosesGzipOrNoCoding) {
  EXPECT_EQ(server::wants_gzip(GetParam().accept_encoding), GetParam().gzip);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, AcceptEncoding,
    testing::Values(CodingCase{"Nothing", "", false},
                    CodingCase{"Gzip", "gzip", true},
                    CodingCase{"OldName", "x-gzip", true},
                    CodingCase{"Capitals", "GZip", true},
                    CodingCase{"Browser", "gzip, deflate, br, zstd", true},
                    CodingCase{"NotTheFirst", "br;q=1.0,\tgzip;q=0.1", true},
                    CodingCase{"Refused", "gzip;q=0", false},
                    CodingCase{"RefusedWithDigits", "gzip; Q=0.000, *", false},
                    CodingCase{"Others", "br, deflate", false},
                    CodingCase{"LongerName", "gzipped", false},
                    CodingCase{"Any", "*", true},
                    CodingCase{"AnyRefused", "*;q=0", false},
                    CodingCase{"AnyOtherRefused", "gzip, *;q=0", true},
                    CodingCase{"Identity", "identity", false},
                    CodingCase{"IdentityRefused", "gzip;q=0.1, identity;q=0", true},
                    CodingCase{"IdentityRather", "gzip;q=0.5, identity", false},
                    CodingCase{"IdentityRatherAsOneOfAny", "gzip;q=0.5, *", false},
                    CodingCase{"Equal", "identity;q=0.5, gzip;q=0.5", true},
                    CodingCase{"BothRefused", "gzip;q=0, identity;q=0", false}),
    [](const auto& case_info) { return case_info.param.name; });

}  // namespace
