// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "jobs/service.h"
#include "server/context/request_context.h"

namespace server {

// The routes below /v1/searches and /v1/wear-studies, which do the same with studies of their kind.

template <jobs::Study kStudy>
[[nodiscard]] Response post_study(const RequestContext& context);
template <jobs::Study kStudy>
[[nodiscard]] Response get_studies(const RequestContext& context);
template <jobs::Study kStudy>
[[nodiscard]] Response get_study(const RequestContext& context);
template <jobs::Study kStudy>
[[nodiscard]] Response delete_study(const RequestContext& context);
template <jobs::Study kStudy>
[[nodiscard]] Response get_study_results(const RequestContext& context);
template <jobs::Study kStudy>
[[nodiscard]] Response get_study_events(const RequestContext& context);
template <jobs::Study kStudy>
[[nodiscard]] Response cancel_study(const RequestContext& context);
template <jobs::Study kStudy>
[[nodiscard]] Response retry_study(const RequestContext& context);

}  // namespace server
