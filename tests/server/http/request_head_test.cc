// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_head.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using server::find_fault_in_head;
using server::OriginCheck;

constexpr std::size_t kHeadBodyBytes = 1000;

struct HeadCase {
  std::string name;
  std::string head;  ///< without the empty line
  int status;        ///< 0: no fault
};
void PrintTo(const HeadCase& c, std::ostream* out) { *out << c.name; }

class Head : public testing::TestWithParam<HeadCase> {};

TEST_P(Head, IsRefusedWithItsStatus) {
  const auto fault = find_fault_in_head(GetParam().head + "\r\n\r\n", kHeadBodyBytes);
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
        HeadCase{"NoHostAsInHttp10", "GET /healthz HTTP/1.0", 0},
        HeadCase{"TwoHostsInHttp10", "GET / HTTP/1.0\r\nHost: a\r\nhost: b", 400},
        HeadCase{"TwoHosts", "GET / HTTP/1.1\r\nHost: a\r\nhost: b", 400},
        HeadCase{"TwoLengths", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nContent-length: 5", 400},
        HeadCase{"LengthAndChunked",
                 "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nTransfer-Encoding: chunked", 400},
        HeadCase{"OtherEncoding", "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: gzip, chunked", 501},
        HeadCase{"SignedLength", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: -5", 400},
        HeadCase{"ListOfLengths", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5, 5", 400},
        HeadCase{"EmptyLength", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length:", 400},
        HeadCase{"LargeLength", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1001", 413},
        HeadCase{"LengthBeyond64Bit", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999999999999999",
                 413},
        HeadCase{"BlankBeforeColon", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length : 5", 400},
        HeadCase{"FoldedLine", "GET / HTTP/1.1\r\nHost: a\r\nX: 1\r\n Y: 2", 400},
        HeadCase{"BareLineFeed", "GET / HTTP/1.1\r\nHost: a\r\nX: 1\nContent-Length: 5", 400},
        HeadCase{"BareCarriageReturn", "GET / HTTP/1.1\r\nHost: a\r\nX: 1\rY: 2", 400},
        HeadCase{"Nul", "GET / HTTP/1.1\r\nHost: a\r\nX: 1" + std::string(1, '\0'), 400},
        HeadCase{"EmptyKey", "POST / HTTP/1.1\r\nHost: a\r\nidempotency-key: ", 400},
        HeadCase{"ConditionWithoutValue", "DELETE /v1/sweeps/a HTTP/1.1\r\nHost: a\r\nIf-Match: ", 400},
        HeadCase{"Key", "POST / HTTP/1.1\r\nHost: a\r\nIdempotency-Key: a", 0},
        HeadCase{"NulInValue", "GET / HTTP/1.1\r\nHost: localhost" + std::string(1, '\0') + ".evil.example",
                 400},
        HeadCase{"DeleteInValue", "GET / HTTP/1.1\r\nHost: a\r\nX: \x7f", 400},
        HeadCase{"EscapeInValue", "GET / HTTP/1.1\r\nHost: a\r\nX: \x1b[2J", 400},
        HeadCase{"EncodedControlCharacters", "GET / HTTP/1.1\r\nHost: a\r\nX: %00%0d%0a%7f", 0},
        HeadCase{"NameThatIsNoToken", "GET / HTTP/1.1\r\nHost: a\r\nX(1): 2", 400},
        HeadCase{"NameBeyondAscii", "GET / HTTP/1.1\r\nHost: a\r\nX\xe9: 2", 400},
        HeadCase{"NameOfSigns", "GET / HTTP/1.1\r\nHost: a\r\n!#$%&'*+-.^_`|~1: 2", 0},
        HeadCase{"NoName", "GET / HTTP/1.1\r\nHost: a\r\n: 1", 400},
        HeadCase{"NoPath", "GET\r\nHost: a", 400},
        HeadCase{"AbsoluteTarget", "GET http://a/ HTTP/1.1\r\nHost: a", 0},
        HeadCase{"AbsoluteTargetWithoutPath", "GET HTTPS://a:8080?limit=1 HTTP/1.1\r\nHost: a", 0},
        HeadCase{"AbsoluteTargetWithoutHost", "GET http:///v1 HTTP/1.1\r\nHost: a", 400},
        HeadCase{"AbsoluteTargetWithUser", "GET http://user@a/ HTTP/1.1\r\nHost: a", 400},
        HeadCase{"AbsoluteTargetOfOtherScheme", "GET ftp://a/ HTTP/1.1\r\nHost: a", 400},
        HeadCase{"AbsoluteLongerPath", "GET http://a/" + std::string(512, 'a') + " HTTP/1.1\r\nHost: a", 414},
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
  for (const char* const origin : {"https://lab.example.org.evil.com", "http://lab.example.org",
                                   "https://lab.example.org:444", "null", ""}) {
    EXPECT_TRUE(check.find_fault({"POST", "localhost:80", origin, "cross-site", "cors"})) << origin;
  }
  // And it does not make another name of this server good.
  EXPECT_TRUE(check.find_fault({"GET", "evil.com", "https://lab.example.org", "cross-site", "cors"}));
}

TEST(Origin, IsTheSameInEverySpelling) {
  for (const char* const option : {"https://lab.example.org", "https://lab.example.org:443", "HTTPS://LAB.example.org", "https://lab.example.org:"}) {
    const OriginCheck check("127.0.0.1", {option});
    EXPECT_FALSE(check.find_fault({"POST", "localhost:80", "https://lab.example.org", "cross-site", "cors"})) << option;
    EXPECT_TRUE(check.find_fault({"POST", "localhost:80", "https://lab.example.org:80", "cross-site", "cors"})) << option;
  }
  EXPECT_EQ(server::normal_origin("http://[::1]:80"), "http://[::1]");
  EXPECT_EQ(server::normal_origin("http://[::1]"), "http://[::1]");
  EXPECT_EQ(server::normal_origin("http://a:443"), "http://a:443");
  EXPECT_EQ(server::normal_origin("null"), "null");
  // A proxy may pass the port on that the browser leaves out.
  const OriginCheck check("127.0.0.1", {}, {"rpsup.example.org"});
  EXPECT_FALSE(check.find_fault({"POST", "rpsup.example.org:443", "https://rpsup.example.org", "same-origin", "cors"}));
  EXPECT_FALSE(check.find_fault({"POST", "rpsup.example.org:80", "http://rpsup.example.org", "same-origin", "cors"}));
  EXPECT_TRUE(check.find_fault({"POST", "rpsup.example.org:80", "https://rpsup.example.org", "same-origin", "cors"}));
}

TEST(BasePath, IsOneOfAProxy) {
  for (const auto& [text, path] : {std::pair{"/rpsup", "/rpsup"}, {"/rpsup/", "/rpsup"}, {"/", ""}, {"", ""}, {"/user/a%20b/proxy/8080/", "/user/a%20b/proxy/8080"},
                                   {"/a, /b/", "/a/b"}, {"/a,", "/a"}})
    EXPECT_EQ(server::find_base_path(text), path) << text;
  for (const char* const text : {"rpsup", "//evil.example", "/a//b", "/a/../b", "/a/./b", "/a?b", "/a#b", "/a b", "https://evil.example", "/a\\b", "/<b>", "/a, b"})
    EXPECT_FALSE(server::find_base_path(text)) << text;
}

TEST(Origin, MayComeThroughAProxyUnderAnotherName) {
  const OriginCheck check("127.0.0.1", {}, {"rpsup.example.org", "10.0.0.7"});
  EXPECT_FALSE(check.find_fault({"GET", "rpsup.example.org", "", "", ""}));
  EXPECT_FALSE(check.find_fault(
      {"DELETE", "RPSUP.example.org:8443", "https://rpsup.example.org:8443", "same-origin", "cors"}));
  EXPECT_FALSE(check.find_fault({"POST", "10.0.0.7:8080", "http://10.0.0.7:8080", "same-origin", "cors"}));
  // Its neighbours, its other ports, and a page that the browser says is from elsewhere.
  EXPECT_TRUE(check.find_fault({"POST", "rpsup.example.org", "https://example.org", "", ""}));
  EXPECT_TRUE(check.find_fault({"POST", "rpsup.example.org", "https://rpsup.example.org:444", "", ""}));
  EXPECT_TRUE(
      check.find_fault({"POST", "rpsup.example.org", "https://rpsup.example.org", "cross-site", "cors"}));
  EXPECT_TRUE(check.find_fault({"GET", "a.rpsup.example.org", "", "", ""}));
  // No proxy stands before the addresses of the loopback.
  EXPECT_TRUE(check.find_fault({"POST", "localhost:80", "https://localhost:80", "", ""}));
}

TEST(ReadHead, TakesHeadersLiterally) {
  const server::RequestHead head = server::read_head(
      "GET / HTTP/1.1\r\nHOST: localhost%00.evil.example\r\nIdempotency-Key:\t k%41%u0041+%2541 "
      "\r\nX-Empty:\r\nAccept: a/b; c=\"d:e\"\r\naccept: f/g\r\n\r\n");
  const std::map<std::string, std::string> expected{{"host", "localhost%00.evil.example"},
                                                    {"idempotency-key", "k%41%u0041+%2541"},
                                                    {"x-empty", ""},
                                                    {"accept", "a/b; c=\"d:e\", f/g"}};
  EXPECT_EQ(head.headers, expected);
}

TEST(RawHeader, IsFoundInAnyHead) {
  EXPECT_EQ(server::raw_header_of("GET /: HTTP/1.1\r\nHost: a\r\nORIGIN:\t https://a \r\n\r\n", "origin"),
            "https://a");
  EXPECT_EQ(server::raw_header_of("GET / HTTP/1.1\r\nno name\r\nOrigin: https://a", "origin"), "https://a");
  for (const char* const head :
       {"", "\r\n", "GET", "origin", "GET / HTTP/1.1\r\nHost: a\r\n\r\nOrigin: https://a\r\n",
        "GET / HTTP/1.1\r\nX-Origin: a\r"})
    EXPECT_EQ(server::raw_header_of(head, "origin"), "") << head;
}

struct TargetCase {
  std::string name;
  std::string target;
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
};
void PrintTo(const TargetCase& c, std::ostream* out) { *out << c.name; }

class Target : public testing::TestWithParam<TargetCase> {};

TEST_P(Target, IsDecodedOnce) {
  const server::RequestHead head =
      server::read_head("GET " + GetParam().target + " HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(head.request_line, "GET / HTTP/1.1");
  EXPECT_EQ(head.path, GetParam().path);
  EXPECT_EQ(head.query, GetParam().query);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Target,
    testing::Values(
        TargetCase{"Plain", "/a/b", "/a/b", {}},
        TargetCase{"EncodedPath", "/%61%2Fb%2fc", "/a/b/c", {}},
        TargetCase{"EncodedTwice", "/%2561?a=%252b", "/%61", {{"a", "%2b"}}},
        TargetCase{"Nul", "/a%00b", std::string("/a\0b", 4), {}},
        TargetCase{"NoTriplets", "/%4%g1%u0041%", "/%4%g1%u0041%", {}},
        TargetCase{"SignedTriplets", "/%-1%+1%0x", "/%-1%+1%0x", {}},
        TargetCase{"PlusInPath", "/a+b", "/a+b", {}},
        TargetCase{"PlusInQuery", "/?a+b=c+d%2Be", "/", {{"a b", "c d+e"}}},
        TargetCase{"Query", "/a?b=1&c=%26%3D", "/a", {{"b", "1"}, {"c", "&="}}},
        TargetCase{"EqualsInValue", "/?a=b=c", "/", {{"a", "b=c"}}},
        TargetCase{"QuestionMarkInValue", "/?a=b?c", "/", {{"a", "b?c"}}},
        TargetCase{"KeyTwice", "/?b=1&a=2&b=1", "/", {{"b", "1"}, {"a", "2"}, {"b", "1"}}},
        TargetCase{"EmptyItems", "/?&a&&b=&=c&", "/", {{"a", ""}, {"b", ""}, {"", "c"}}},
        TargetCase{"Fragment", "/a?b=1#c?d=2", "/a", {{"b", "1"}}}),
    [](const auto& case_info) { return case_info.param.name; });

TEST(Loopback, IsWhatOnlyThisMachineReaches) {
  for (const char* const host : {"127.0.0.1", "127.1.2.3", "::1", "localhost"})
    EXPECT_TRUE(server::is_loopback(host)) << host;
  for (const char* const host :
       {"0.0.0.0", "::", "128.0.0.1", "10.0.0.1", "127.0.0.1.evil.com", "", "example.org"}) {
    EXPECT_FALSE(server::is_loopback(host)) << host;
  }
}

}  // namespace
