// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_head.h"

#include <string>

#include <gtest/gtest.h>

namespace {

using server::find_fault_in_head;
using server::OriginCheck;

constexpr std::size_t kBodyBytes = 1000;

struct HeadCase {
  std::string name;
  std::string head;  ///< without the empty line
  int status;        ///< 0: no fault
};
void PrintTo(const HeadCase& c, std::ostream* out) { *out << c.name; }

class Head : public testing::TestWithParam<HeadCase> {};

TEST_P(Head, IsRefusedWithItsStatus) {
  const auto fault = find_fault_in_head(GetParam().head + "\r\n\r\n", kBodyBytes);
  EXPECT_EQ(fault ? fault->status : 0, GetParam().status) << (fault ? fault->detail : "");
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Head,
    testing::Values(
        HeadCase{"Plain", "GET / HTTP/1.1\r\nHost: a", 0},
        HeadCase{"Query", "GET /v1/sweeps?limit=5 HTTP/1.1\r\nHost: a\r\nAccept: text/csv", 0},
        HeadCase{"Length", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1000", 0},
        HeadCase{"Chunked", "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: Chunked", 0},
        HeadCase{"NoHost", "GET / HTTP/1.1\r\nAccept: a", 400},
        HeadCase{"TwoHosts", "GET / HTTP/1.1\r\nHost: a\r\nhost: b", 400},
        HeadCase{"TwoLengths", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nContent-length: 5", 400},
        HeadCase{"LengthAndChunked", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nTransfer-Encoding: chunked", 400},
        HeadCase{"OtherEncoding", "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: gzip, chunked", 501},
        HeadCase{"SignedLength", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: -5", 400},
        HeadCase{"ListOfLengths", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5, 5", 400},
        HeadCase{"EmptyLength", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length:", 400},
        HeadCase{"LargeLength", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1001", 413},
        HeadCase{"LengthBeyond64Bit", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999999999999999", 413},
        HeadCase{"BlankBeforeColon", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length : 5", 400},
        HeadCase{"FoldedLine", "GET / HTTP/1.1\r\nHost: a\r\nX: 1\r\n Y: 2", 400},
        HeadCase{"BareLineFeed", "GET / HTTP/1.1\r\nHost: a\r\nX: 1\nContent-Length: 5", 400},
        HeadCase{"BareCarriageReturn", "GET / HTTP/1.1\r\nHost: a\r\nX: 1\rY: 2", 400},
        HeadCase{"Nul", "GET / HTTP/1.1\r\nHost: a\r\nX: 1" + std::string(1, '\0'), 400},
        HeadCase{"EmptyKey", "POST / HTTP/1.1\r\nHost: a\r\nidempotency-key: ", 400},
        HeadCase{"Key", "POST / HTTP/1.1\r\nHost: a\r\nIdempotency-Key: a", 0},
        HeadCase{"NoName", "GET / HTTP/1.1\r\nHost: a\r\n: 1", 400},
        HeadCase{"NoPath", "GET\r\nHost: a", 400},
        HeadCase{"AbsoluteTarget", "GET http://a/ HTTP/1.1\r\nHost: a", 400},
        HeadCase{"LongestPath", "GET /" + std::string(511, 'a') + " HTTP/1.1\r\nHost: a", 0},
        HeadCase{"LongerPath", "GET /" + std::string(512, 'a') + " HTTP/1.1\r\nHost: a", 414},
        HeadCase{"LongQuery", "GET /?a=" + std::string(7900, 'a') + " HTTP/1.1\r\nHost: a", 0},
        HeadCase{"LongerQuery", "GET /?a=" + std::string(8000, 'a') + " HTTP/1.1\r\nHost: a", 414},
        HeadCase{"LongLine", "GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(7900, 'a'), 0},
        HeadCase{"LongerLine", "GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(8000, 'a'), 431}),
    [](const auto& case_info) { return case_info.param.name; });

struct OriginCase {
  std::string name;
  OriginCheck::Headers headers;
  bool good;
};
void PrintTo(const OriginCase& c, std::ostream* out) { *out << c.name; }

class Origin : public testing::TestWithParam<OriginCase> {};

TEST_P(Origin, IsJudged) {
  const OriginCheck check("127.0.0.2");
  const auto fault = check.find_fault(GetParam().headers);
  EXPECT_EQ(fault ? fault->status : 0, GetParam().good ? 0 : 403);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Origin,
    testing::Values(
        OriginCase{"Curl", {"GET", "127.0.0.1:8080", "", "", ""}, true},
        OriginCase{"Name", {"DELETE", "localhost", "", "", ""}, true},
        OriginCase{"NameInCapitals", {"GET", "LocalHost:8080", "", "", ""}, true},
        OriginCase{"NameWithDot", {"GET", "localhost.:8080", "", "", ""}, true},
        OriginCase{"Version6", {"GET", "[::1]:8080", "", "", ""}, true},
        OriginCase{"BoundAddress", {"GET", "127.0.0.2:1", "", "", ""}, true},
        OriginCase{"OtherName", {"GET", "evil.com", "", "", ""}, false},
        OriginCase{"OtherNameWithPort", {"GET", "evil.com:8080", "", "", ""}, false},
        OriginCase{"NameWithTail", {"GET", "localhost.evil.com", "", "", ""}, false},
        OriginCase{"AddressWithTail", {"GET", "127.0.0.1.evil.com", "", "", ""}, false},
        OriginCase{"NoName", {"GET", "", "", "", ""}, false},
        OriginCase{"OpenBracket", {"GET", "[::1", "", "", ""}, false},
        OriginCase{"OwnPage", {"POST", "localhost:80", "http://localhost:80", "same-origin", "cors"}, true},
        OriginCase{"OtherPort", {"POST", "localhost:80", "http://localhost:81", "", ""}, false},
        OriginCase{"OtherSite", {"DELETE", "localhost:80", "https://evil.com", "", ""}, false},
        OriginCase{"Sandboxed", {"POST", "localhost:80", "null", "", ""}, false},
        OriginCase{"CrossSiteForm", {"POST", "localhost:80", "", "cross-site", "navigate"}, false},
        OriginCase{"CrossSiteImage", {"GET", "localhost:80", "", "cross-site", "no-cors"}, false},
        OriginCase{"OtherPortOfThisMachine", {"GET", "localhost:80", "", "same-site", "cors"}, false},
        OriginCase{"FollowedLink", {"GET", "localhost:80", "", "cross-site", "navigate"}, true},
        OriginCase{"TypedAddress", {"GET", "localhost:80", "", "none", "navigate"}, true}),
    [](const auto& case_info) { return case_info.param.name; });

TEST(Origin, MayBeAnotherSiteThatIsAllowed) {
  const OriginCheck check("127.0.0.1", {"https://lab.example.org"});
  EXPECT_FALSE(check.find_fault({"POST", "localhost:80", "https://lab.example.org", "cross-site", "cors"}));
  EXPECT_FALSE(check.find_fault({"GET", "localhost:80", "HTTPS://LAB.example.org", "cross-site", "cors"}));
  // Neither does a name that begins or ends like it, nor a page that hides where it is from.
  for (const char* const origin : {"https://lab.example.org.evil.com", "http://lab.example.org", "https://lab.example.org:444", "null", ""}) {
    EXPECT_TRUE(check.find_fault({"POST", "localhost:80", origin, "cross-site", "cors"})) << origin;
  }
  // And it does not make another name of this server good.
  EXPECT_TRUE(check.find_fault({"GET", "evil.com", "https://lab.example.org", "cross-site", "cors"}));
}

TEST(Origin, MayComeThroughAProxyUnderAnotherName) {
  const OriginCheck check("127.0.0.1", {}, {"rpsup.example.org", "10.0.0.7"});
  EXPECT_FALSE(check.find_fault({"GET", "rpsup.example.org", "", "", ""}));
  EXPECT_FALSE(check.find_fault({"DELETE", "RPSUP.example.org:8443", "https://rpsup.example.org:8443", "same-origin", "cors"}));
  EXPECT_FALSE(check.find_fault({"POST", "10.0.0.7:8080", "http://10.0.0.7:8080", "same-origin", "cors"}));
  // Its neighbours, its other ports, and a page that the browser says is from elsewhere.
  EXPECT_TRUE(check.find_fault({"POST", "rpsup.example.org", "https://example.org", "", ""}));
  EXPECT_TRUE(check.find_fault({"POST", "rpsup.example.org", "https://rpsup.example.org:444", "", ""}));
  EXPECT_TRUE(check.find_fault({"POST", "rpsup.example.org", "https://rpsup.example.org", "cross-site", "cors"}));
  EXPECT_TRUE(check.find_fault({"GET", "a.rpsup.example.org", "", "", ""}));
  // No proxy stands before the addresses of the loopback.
  EXPECT_TRUE(check.find_fault({"POST", "localhost:80", "https://localhost:80", "", ""}));
}

TEST(WithoutHeader, LeavesTheOtherLinesAsTheyAre) {
  EXPECT_EQ(server::without_header("GET / HTTP/1.1\r\nRANGE: a\r\nHost: b\r\nX: range\r\nrange:c\r\n\r\n", "range"), "GET / HTTP/1.1\r\nHost: b\r\nX: range\r\n\r\n");
}

TEST(Loopback, IsWhatOnlyThisMachineReaches) {
  for (const char* const host : {"127.0.0.1", "127.1.2.3", "::1", "localhost"}) EXPECT_TRUE(server::is_loopback(host)) << host;
  for (const char* const host : {"0.0.0.0", "::", "128.0.0.1", "10.0.0.1", "127.0.0.1.evil.com", "", "example.org"}) {
    EXPECT_FALSE(server::is_loopback(host)) << host;
  }
}

}  // namespace
