#include "jobs/store_quota.h"

#include <string>

#include "jobs/errors.h"

namespace jobs {

void check_quota(SQLite::Statement& used, std::int64_t limit) {
  if (limit == 0) return;
  used.executeStep();
  const std::int64_t bytes = used.getColumn(0).getInt64();
  if (bytes <= limit) return;
  throw StoreLimitReached("the store may hold " + std::to_string(limit / 1'000'000) +
                          " MB and has no room for this; delete sweeps that are not needed any more");
}

}  // namespace jobs
