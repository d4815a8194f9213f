// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "jobs/base/content_id.h"
#include "server/messages/gzip.h"
#include "server/routes/web_files.h"
#include "tests/server/service_fixture.h"

namespace {

using server_tests::Bench;

std::string header_of(const server::Response& response, const std::string& name) {
  const auto found =
      std::ranges::find(response.headers, name, [](const auto& header) { return header.first; });
  return found == response.headers.end() ? "" : found->second;
}

server::Response get_page(Bench& bench, const std::string& path, const std::string& accept_encoding = "",
                          const std::string& if_none_match = "") {
  server::Request request{
      .method = "GET", .path = path, .query = {}, .accept = {}, .body = {}, .id = "test-1"};
  request.accept_encoding = accept_encoding;
  request.if_none_match = if_none_match;
  return bench.call(request);
}

/// The name with a hash under which a page asks for a file of a package.
std::string hashed_name(Bench& bench, const std::string& page, const std::string& path) {
  const auto dot = path.rfind('.');
  const std::string text = get_page(bench, page).body;
  std::smatch found;
  const std::regex name("[\"'][./]*(/?" + path.substr(1, dot - 1) + "\\.[0-9a-f]{16}\\" + path.substr(dot) + ")[\"']");
  if (!std::regex_search(text, found, name)) return "";
  return found[1].str().starts_with('/') ? found[1].str() : "/" + found[1].str();
}

TEST(Page, TravelsCompressedToWhoeverWantsThat) {
  Bench bench;
  for (const char* const path : {"/", "/app.js", "/style/base.css", "/icon.svg", "/linkages/rsup.json"}) {
    const auto plain = get_page(bench, path);
    const auto packed = get_page(bench, path, "gzip");
    EXPECT_EQ(plain.status, 200) << path;
    EXPECT_EQ(packed.status, 200) << path;
    EXPECT_EQ(header_of(plain, "Content-Encoding"), "") << path;
    EXPECT_EQ(header_of(packed, "Content-Encoding"), "gzip") << path;
    EXPECT_EQ(packed.content_type, plain.content_type) << path;
    ASSERT_FALSE(plain.body.empty()) << path;
    EXPECT_EQ(server::gunzip(packed.body, plain.body.size()), plain.body) << path;
    for (const auto* const answer : {&plain, &packed}) {
      EXPECT_EQ(header_of(*answer, "Vary"), "Accept-Encoding") << path;
      EXPECT_EQ(header_of(*answer, "Cache-Control"), "private, no-cache") << path;
    }
  }
}

// Behind a proxy the root of the service is no root of the host.
TEST(Page, NamesItsPartsFromWhereItStands) {
  Bench bench;
  const std::regex from_the_root("(?:href|src)=\"/|(?:from |import\\()[\"']/|fetch\\([\"']/");
  for (const char* const path : {"/", "/docs", "/app.js", "/core/api.js", "/core/uplot.js", "/pages/sweep.js", "/scene/three.js", "/lib/three.module.js", "/docs/docs.js"}) {
    const auto page = get_page(bench, path);
    if (page.status == 404 && std::string(path) != "/") continue;  // built without the packages
    std::smatch found;
    EXPECT_FALSE(std::regex_search(page.body, found, from_the_root)) << path << ": " << found.str();
  }
  EXPECT_NE(get_page(bench, "/app.js").body.find("\"./core/api.js\""), std::string::npos);
  EXPECT_NE(get_page(bench, "/pages/sweep.js").body.find("\"./../core/api.js\""), std::string::npos);
  EXPECT_NE(get_page(bench, "/").body.find("src=\"app.js\""), std::string::npos);
}

TEST(Page, HasATagForEachRepresentation) {
  Bench bench;
  const std::string plain = header_of(get_page(bench, "/app.js"), "ETag");
  const std::string packed = header_of(get_page(bench, "/app.js", "gzip"), "ETag");
  EXPECT_NE(plain, packed);
  EXPECT_NE(plain, header_of(get_page(bench, "/index.html"), "ETag"));
  for (const std::string& tag : {plain, packed})
    EXPECT_TRUE(std::regex_match(tag, std::regex("\"[0-9a-f]{32}\""))) << tag;
  for (const auto& [coding, tag] : {std::pair("", plain), std::pair("gzip", packed)}) {
    const auto known = get_page(bench, "/app.js", coding, "\"another\", " + tag);
    EXPECT_EQ(known.status, 304) << coding;
    EXPECT_EQ(known.body, "") << coding;
    EXPECT_EQ(header_of(known, "ETag"), tag) << coding;
    EXPECT_EQ(header_of(known, "Vary"), "Accept-Encoding") << coding;
    EXPECT_EQ(header_of(known, "Content-Encoding"), "") << coding;
  }
  EXPECT_EQ(get_page(bench, "/app.js", "", packed).status, 200);
  EXPECT_EQ(get_page(bench, "/app.js", "gzip", plain).status, 200);
}

// A file of a package, and a page that asks for it.
struct PackageCase {
  std::string path;
  std::string page;
};
void PrintTo(const PackageCase& c, std::ostream* out) { *out << c.path; }

class Package : public testing::TestWithParam<PackageCase> {};

TEST_P(Package, IsKeptForEverUnderTheHashOfItsContent) {
  const auto& [path, page] = GetParam();
  if (server::find_web_file(path) == nullptr) GTEST_SKIP() << "the program was built without " << path;
  Bench bench;
  const std::string name = hashed_name(bench, page, path);
  ASSERT_NE(name, "") << page;
  const auto plain = get_page(bench, name);
  EXPECT_EQ(plain.status, 200);
  EXPECT_NE(name.find("." + jobs::sha256_hex(plain.body).substr(0, 16) + "."), std::string::npos) << name;
  for (const char* const coding : {"", "gzip"}) {
    const auto kept = get_page(bench, name, coding);
    const auto asked_for_each_time = get_page(bench, path, coding);
    EXPECT_EQ(header_of(kept, "Cache-Control"), "public, max-age=31536000, immutable");
    EXPECT_EQ(header_of(asked_for_each_time, "Cache-Control"), "private, no-cache");
    EXPECT_EQ(kept.body, asked_for_each_time.body);
    EXPECT_EQ(kept.content_type, asked_for_each_time.content_type);
    EXPECT_EQ(get_page(bench, name, coding, header_of(kept, "ETag")).status, 304);
  }
  std::string of_another_build = name;
  char& digit = of_another_build.at(of_another_build.rfind('.') - 1);
  digit = digit == '0' ? '1' : '0';
  EXPECT_EQ(get_page(bench, of_another_build).status, 404);
}

INSTANTIATE_TEST_SUITE_P(All, Package,
                         testing::Values(PackageCase{"/lib/echarts.js", "/core/charts.js"},
                                         PackageCase{"/lib/uplot.js", "/core/uplot.js"},
                                         PackageCase{"/lib/uplot.css", "/core/uplot.js"},
                                         PackageCase{"/lib/three.module.js", "/scene/three.js"},
                                         PackageCase{"/lib/three.module.js", "/lib/orbit_controls.js"},
                                         PackageCase{"/lib/orbit_controls.js", "/scene/three.js"},
                                         PackageCase{"/lib/three.core.js", "/lib/three.module.js"},
                                         PackageCase{"/docs/swagger-ui-bundle.js", "/docs"},
                                         PackageCase{"/docs/swagger-ui.css", "/docs"}));

TEST(Gunzip, RefusesWhatIsNotThatText) {
  Bench bench;
  const std::size_t size = get_page(bench, "/app.js").body.size();
  std::string packed = get_page(bench, "/app.js", "gzip").body;
  EXPECT_THROW(static_cast<void>(server::gunzip(packed, size - 1)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(server::gunzip(packed, size + 1)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(server::gunzip(packed.substr(0, packed.size() - 1), size)),
               std::runtime_error);
  EXPECT_THROW(static_cast<void>(server::gunzip(packed + "a", size)), std::runtime_error);
  packed[packed.size() / 2] = static_cast<char>(packed[packed.size() / 2] ^ 1);
  EXPECT_THROW(static_cast<void>(server::gunzip(packed, size)), std::runtime_error);
}

}  // namespace
