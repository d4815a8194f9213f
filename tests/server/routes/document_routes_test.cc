// SPDX-License-Identifier: Apache-2.0
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "jobs/requests/design_kinds.h"
#include "jobs/requests/sweep_request.h"
#include "server/routes/route_table.h"
#include "server/routes/web_files.h"
#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;

/// The values of every "$ref" in a document.
void gather_refs(const json& value, std::set<std::string>& refs) {
  for (const auto& [key, part] : value.items()) {
    if (key == "$ref") {
      refs.insert(part.get<std::string>());
    } else if (part.is_structured()) {
      gather_refs(part, refs);
    }
  }
}

TEST(OpenApi, DescribesEveryRouteOnce) {
  Bench bench;
  const auto response = bench.call("GET", "/v1/openapi.json");
  EXPECT_EQ(response.content_type, "application/json");
  const json document = json::parse(response.body);
  std::size_t operations = 0;
  std::set<std::string> ids;
  for (const auto& [path, item] : document.at("paths").items()) {
    for (const auto& [method, operation] : item.items()) {
      ++operations;
      ids.insert(operation.at("operationId").get<std::string>());
      EXPECT_EQ(operation.contains("requestBody"),
                method == "patch" ||
                    (method == "post" && !path.ends_with("/cancel") && !path.ends_with("/retry")))
          << method << path;
    }
  }
  EXPECT_EQ(operations, server::route_table().size());
  EXPECT_EQ(ids.size(), operations);
}

TEST(OpenApi, PointsAtNothingThatIsNotThere) {
  Bench bench;
  const json document = json::parse(bench.call("GET", "/v1/openapi.json").body);
  std::set<std::string> refs;
  gather_refs(document, refs);
  EXPECT_GT(refs.size(), 50U);
  for (const std::string& ref : refs)
    EXPECT_TRUE(document.contains(json::json_pointer(ref.substr(1)))) << ref;
}

// One table: what GET /v1/parameters says is what the document says, word by word.
TEST(OpenApi, HasTheParametersOfTheService) {
  Bench bench;
  const json document = json::parse(bench.call("GET", "/v1/openapi.json").body);
  json parameters = json::parse(bench.call("GET", "/v1/parameters").body);
  parameters.erase("$schema");
  EXPECT_EQ(document.at("components").at("schemas").at("Parameters"), parameters);
  EXPECT_EQ(document.at("components")
                .at("schemas")
                .at("Ranges")
                .at("properties")
                .at("links.2,1.mass_kg")
                .at("anyOf")
                .at(0)
                .at("items")
                .at("$ref"),
            "#/components/schemas/Parameters/properties/links/properties/2,1/properties/mass_kg");
}

TEST(OpenApi, KnowsEveryKeyOfASweepRequestAndOfADesign) {
  Bench bench;
  const json schemas = json::parse(bench.call("GET", "/v1/openapi.json").body).at("components").at("schemas");
  EXPECT_EQ(schemas.at("SweepRequest").at("properties").size(), jobs::kSweepRequestKeys.size());
  for (const auto key : jobs::kSweepRequestKeys)
    EXPECT_TRUE(schemas.at("SweepRequest").at("properties").contains(key)) << key;
  EXPECT_EQ(schemas.at("Design").at("oneOf").size(), jobs::design_kinds().size());
  for (const json& design : schemas.at("Design").at("oneOf"))
    EXPECT_EQ(design.at("additionalProperties"), false);
}

// Every part of the page comes from the program, and the page's policy allows no others. The program may
// have been built without the page.
TEST(Docs, ServeThePageWithAllItsParts) {
  Bench bench;
  const auto page = bench.call("GET", "/docs");
  if (server::find_web_file("/docs/swagger-ui-bundle.js") == nullptr) {
    EXPECT_EQ(page.status, 404);
    EXPECT_NE(page.body.find("built without the page"), std::string::npos);
    return;
  }
  ASSERT_EQ(page.status, 200);
  const std::regex part(R"re((src|href)="(docs/[^"]+)")re");
  std::size_t parts = 0;
  for (std::sregex_iterator found(page.body.begin(), page.body.end(), part), end; found != end;
       ++found, ++parts) {
    const auto response = bench.call("GET", "/" + (*found)[2].str());
    EXPECT_EQ(response.status, 200) << (*found)[2];
    EXPECT_GT(response.body.size(), 100U) << (*found)[2];
  }
  EXPECT_EQ(parts, 4U);
  EXPECT_NE(server_tests::header(page, "Content-Security-Policy").find("img-src 'self' data:"), std::string::npos);
  EXPECT_EQ(page.body.find("//"), std::string::npos) << "of another site";
  for (const char* const forbidden : {"style=", "onclick", "<script>"})
    EXPECT_EQ(page.body.find(forbidden), std::string::npos);
}

}  // namespace
