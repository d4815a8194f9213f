// SPDX-License-Identifier: Apache-2.0
// The bodies of POST /v1/sweeps, of its extension, of POST /v1/searches and of POST /v1/wear-studies, from
// their bytes to the jobs that they mean.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "jobs/base/errors.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/extend_request.h"
#include "jobs/search/search_request.h"
#include "jobs/wear/wear_request.h"
#include "server/messages/json_text.h"
#include "tests/fuzz/expect.h"

namespace {

constexpr std::size_t kMostJobs = 8;

/// Nothing new, if a sweep is extended by what it has.
void check_extension(const nlohmann::ordered_json& request) {
  nlohmann::ordered_json own = nlohmann::ordered_json::object();
  for (const char* const key : {"sweep", "cases"}) {
    if (request.contains(key)) own[key] = request.at(key);
  }
  if (own.empty()) return;
  const jobs::Extension nothing = jobs::plan_extension(request, own, kMostJobs);
  fuzz::expect(nothing.jobs.empty() && nothing.request == request,
               "a sweep has its own axes and cases already");
}

void check_plan(const nlohmann::ordered_json& request, const jobs::SweepPlan& plan) {
  fuzz::expect(!plan.jobs.empty() && plan.jobs.size() <= kMostJobs,
               "a sweep has from one job to as many as are allowed");
  const jobs::SweepPlan again = jobs::plan_sweep(server::parse_json(server::to_text(request)), kMostJobs);
  fuzz::expect(again.jobs.size() == plan.jobs.size(), "a request that was stored means as many jobs");
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    fuzz::expect(again.jobs[i].content_id == plan.jobs[i].content_id,
                 "a request that was stored means the same jobs");
  }
  const jobs::PlannedJob& last = plan.jobs.back();
  const jobs::PlannedJob alone = jobs::plan_job(nlohmann::json::parse(last.parameters));
  fuzz::expect(alone.content_id == last.content_id, "the parameters of a job, sent alone, are the same job");
  fuzz::expect(alone.parameters == last.parameters, "canonical parameters are canonical");
  check_extension(request);
}

/// Does what a request asks for; a refusal names what is wrong.
template <typename Ask>
void expect_clear_refusal(const Ask& ask) {
  try {
    ask();
  } catch (const jobs::InvalidRequest& invalid) {
    fuzz::expect(!invalid.faults().empty(), "a refusal names a fault");
    for (const jobs::Fault& fault : invalid.faults()) {
      fuzz::expect(fault.pointer.empty() || fault.pointer.front() == '/', "a fault has a JSON pointer");
      fuzz::expect(!fault.detail.empty(), "a fault has a sentence");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nlohmann::ordered_json request;
  try {
    request = server::parse_json(std::string_view(reinterpret_cast<const char*>(data), size));
  } catch (const server::BadJson&) {
    return 0;
  }
  expect_clear_refusal([&] { check_plan(request, jobs::plan_sweep(request, kMostJobs)); });
  expect_clear_refusal([&] {
    const jobs::SearchRequest search = jobs::parse_search_request(request, kMostJobs);
    (void)jobs::plan_first_sweep(jobs::first_sweep_of(request, search), search, kMostJobs);
  });
  expect_clear_refusal([&] {
    const jobs::WearStudyRequest study = jobs::parse_wear_request(request, kMostJobs);
    const jobs::SweepPlan plan = jobs::plan_sweep(jobs::first_sweep_of(request, study), kMostJobs);
    fuzz::expect(plan.jobs.size() == 1, "a wear study begins with one bore");
  });
  return 0;
}
