#pragma once

#include "server/routes.h"

namespace server {

// The routes below /v1/searches.

[[nodiscard]] Response post_search(const Call& call);
[[nodiscard]] Response get_searches(const Call& call);
[[nodiscard]] Response get_search(const Call& call);
[[nodiscard]] Response delete_search(const Call& call);
[[nodiscard]] Response get_limits(const Call& call);
[[nodiscard]] Response cancel_search(const Call& call);
[[nodiscard]] Response retry_search(const Call& call);

}  // namespace server
