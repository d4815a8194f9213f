// SPDX-License-Identifier: Apache-2.0
#include "server/messages/error_answer.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"

namespace {

using server::make_error_answer;
using server::Response;

struct ErrorCase {
  std::string name;
  std::exception_ptr error;
  int status;
  bool tells_the_text;  ///< the user sees what was thrown
};
void PrintTo(const ErrorCase& c, std::ostream* out) { *out << c.name; }

class ErrorAnswer : public testing::TestWithParam<ErrorCase> {};

TEST_P(ErrorAnswer, IsAProblemWithItsStatus) {
  const Response response = make_error_answer(GetParam().error, "request-7");
  EXPECT_EQ(response.status, GetParam().status);
  EXPECT_EQ(response.content_type, "application/problem+json");
  const auto problem = nlohmann::json::parse(response.body);
  EXPECT_EQ(problem.at("status"), GetParam().status);
  EXPECT_EQ(problem.at("type"), "about:blank");
  EXPECT_FALSE(problem.at("title").get<std::string>().empty());
  const auto detail = problem.at("detail").get<std::string>();
  EXPECT_EQ(detail.find("secret") != std::string::npos, GetParam().tells_the_text) << detail;
  // An answer that hides the error's text names the request, under which the log has the text.
  EXPECT_EQ(detail.find("request-7") != std::string::npos, !GetParam().tells_the_text) << detail;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ErrorAnswer,
    testing::Values(
        ErrorCase{"Http", std::make_exception_ptr(server::HttpError(404, "secret")), 404, true},
        ErrorCase{"BadJson", std::make_exception_ptr(server::BadJson("secret")), 400, true},
        ErrorCase{"Invalid",
                  std::make_exception_ptr(jobs::InvalidRequest(std::vector<jobs::Fault>{{"/a", "secret"}})),
                  422, true},
        ErrorCase{"QueueFull", std::make_exception_ptr(jobs::QueueFull("secret")), 429, true},
        ErrorCase{"WrongState", std::make_exception_ptr(jobs::WrongState("secret")), 409, true},
        ErrorCase{"Stopped", std::make_exception_ptr(jobs::Stopped("secret")), 503, true},
        ErrorCase{"NoMemory", std::make_exception_ptr(std::bad_alloc()), 503, false},
        ErrorCase{"StoreLimit", std::make_exception_ptr(jobs::StoreLimitReached("secret")), 507, true},
        ErrorCase{"DiskFull", std::make_exception_ptr(jobs::StorageError("secret", 13, jobs::Disk::kFull)),
                  507, false},
        ErrorCase{"DiskBroken", std::make_exception_ptr(jobs::StorageError("secret", 10)), 503, false},
        ErrorCase{"Other", std::make_exception_ptr(std::logic_error("secret")), 500, false},
        ErrorCase{"NoException", std::make_exception_ptr(42), 500, false}),
    [](const auto& case_info) { return case_info.param.name; });

TEST(InvalidRequestAnswer, HoldsEveryFault) {
  const auto response = make_error_answer(
      std::make_exception_ptr(jobs::InvalidRequest({{"/a/0", "too small"}, {"/b", "unknown"}})), "r");
  EXPECT_EQ(nlohmann::json::parse(response.body).at("errors"),
            nlohmann::json::parse(
                R"([{"pointer": "/a/0", "detail": "too small"}, {"pointer": "/b", "detail": "unknown"}])"));
}

TEST(InvalidRequestAnswer, SaysHowManyFaultsItLeavesOut) {
  const auto problem_of = [](std::size_t count) {
    const std::vector<jobs::Fault> faults(count, {"/a", "unknown"});
    return nlohmann::json::parse(
        make_error_answer(std::make_exception_ptr(jobs::InvalidRequest(faults)), "r").body);
  };
  EXPECT_EQ(problem_of(100).at("errors").size(), 100U);
  EXPECT_EQ(problem_of(100).at("detail").get<std::string>().find("left out"), std::string::npos);
  EXPECT_EQ(problem_of(1234).at("errors").size(), 100U);
  EXPECT_NE(problem_of(1234).at("detail").get<std::string>().find("; 1134 more are left out here"),
            std::string::npos);
}

TEST(RetryLater, SaysWhen) {
  const auto response = server::make_retry_later(503, "later");
  ASSERT_EQ(response.headers.size(), 1U);
  EXPECT_EQ(response.headers[0].first, "Retry-After");
  EXPECT_GT(std::stoi(response.headers[0].second), 0);
}

TEST(Problem, SurvivesTextThatIsNoUtf8) {
  const auto problem = nlohmann::json::parse(server::make_problem(400, "\xff").body);
  EXPECT_EQ(problem.at("detail"), "\xef\xbf\xbd");
}

}  // namespace
