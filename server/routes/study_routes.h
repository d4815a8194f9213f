// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "jobs/service.h"
#include "server/routing/call.h"

namespace server {

// The routes below /v1/searches and /v1/wear-studies, which do the same with studies of their kind.

template <jobs::Study kStudy>
[[nodiscard]] Response post_study(const Call& call);
template <jobs::Study kStudy>
[[nodiscard]] Response get_studies(const Call& call);
template <jobs::Study kStudy>
[[nodiscard]] Response get_study(const Call& call);
template <jobs::Study kStudy>
[[nodiscard]] Response delete_study(const Call& call);
template <jobs::Study kStudy>
[[nodiscard]] Response get_study_results(const Call& call);
template <jobs::Study kStudy>
[[nodiscard]] Response get_study_events(const Call& call);
template <jobs::Study kStudy>
[[nodiscard]] Response cancel_study(const Call& call);
template <jobs::Study kStudy>
[[nodiscard]] Response retry_study(const Call& call);

}  // namespace server
