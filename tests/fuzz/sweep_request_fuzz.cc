// The body of POST /v1/sweeps, from its bytes to the jobs that it means.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "jobs/errors.h"
#include "jobs/expand.h"
#include "server/json_text.h"
#include "tests/fuzz/expect.h"

namespace {

constexpr std::size_t kMostJobs = 8;

void check_plan(const nlohmann::ordered_json& request, const jobs::SweepPlan& plan) {
  fuzz::expect(!plan.jobs.empty() && plan.jobs.size() <= kMostJobs, "a sweep has from one job to as many as are allowed");
  const jobs::SweepPlan again = jobs::plan_sweep(server::parse_json(server::to_text(request)), kMostJobs);
  fuzz::expect(again.jobs.size() == plan.jobs.size(), "a request that was stored means as many jobs");
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    fuzz::expect(again.jobs[i].content_id == plan.jobs[i].content_id, "a request that was stored means the same jobs");
  }
  const jobs::PlannedJob& last = plan.jobs.back();
  const jobs::PlannedJob alone = jobs::plan_job(nlohmann::json::parse(last.parameters));
  fuzz::expect(alone.content_id == last.content_id, "the parameters of a job, sent alone, are the same job");
  fuzz::expect(alone.parameters == last.parameters, "canonical parameters are canonical");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto request = server::parse_json(std::string_view(reinterpret_cast<const char*>(data), size));
    check_plan(request, jobs::plan_sweep(request, kMostJobs));
  } catch (const server::BadJson&) {
    return 0;
  } catch (const jobs::InvalidRequest& invalid) {
    fuzz::expect(!invalid.faults().empty(), "a refusal names a fault");
    for (const jobs::Fault& fault : invalid.faults()) {
      fuzz::expect(fault.pointer.empty() || fault.pointer.front() == '/', "a fault has a JSON pointer");
      fuzz::expect(!fault.detail.empty(), "a fault has a sentence");
    }
  }
  return 0;
}
