// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "jobs/base/errors.h"
#include "jobs/service.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

TEST(Service, DeletesWhatHasEndedOnly) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = submitted(service, "{}");
  EXPECT_THROW((void)service.delete_sweep(id), jobs::WrongState);
  engine.release();
  finished(service, id);
  EXPECT_TRUE(service.delete_sweep(id));
  EXPECT_FALSE(service.delete_sweep(id));
  EXPECT_FALSE(service.find_sweep(id).has_value());
}

/// No file of this process may grow beyond a size, as if the disk were full there.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t size) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{.rlim_cur = size, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~SizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SizeLimit(const SizeLimit&) = delete;
  SizeLimit& operator=(const SizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

// The log, which is new, may grow by a page more each time, until there is room to delete some jobs at a
// time: there is none to delete all at once, but it is enough to make the file smaller, too.
TEST(Service, DeletesOrRefusesToWhereTheDiskIsFull) {
  constexpr rlim_t kPage = 8192;
  const TemporaryStore temporary;
  FakeEngine engine;
  auto options = options_of(temporary, engine, 2);
  std::string first;
  {
    jobs::Service service(options);
    first = submitted(service, R"({"sweep": {"crank_velocity_rad_s": {"from": 1, "to": 2, "count": 100}}})");
    EXPECT_EQ(finished(service, first).at("state"), "succeeded");
    EXPECT_EQ(
        finished(service,
                 submitted(service, R"({"sweep": {"clearance_mm": {"from": 0.1, "to": 0.2, "count": 100}}})"))
            .at("state"),
        "succeeded");
  }
  std::vector<std::string> told;
  options.log = [&](const std::string& line) { told.push_back(line); };
  jobs::Service service(options);
  const auto size = std::filesystem::file_size(temporary.file());
  bool deleted = false;
  for (rlim_t pages = 1; !deleted && pages < 10'000; ++pages) {
    try {
      const SizeLimit limit(pages * kPage);
      deleted = service.delete_sweep(first);
    } catch (const jobs::StorageError& error) {
      EXPECT_TRUE(error.full);
      ASSERT_TRUE(service.find_sweep(first).has_value()) << "refused, but deleted";
    }
  }
  EXPECT_TRUE(deleted);
  EXPECT_FALSE(service.find_sweep(first).has_value());
  EXPECT_TRUE(told.empty()) << told.front();
  EXPECT_LT(std::filesystem::file_size(temporary.file()), size);
}

}  // namespace
}  // namespace jobs_tests
