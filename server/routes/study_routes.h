// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "jobs/service.h"
#include "server/context/request_context.h"

namespace server {

/// Routes of one kind of study, below the path of jobs::kind_info().
template <jobs::StudyKind kKind>
struct StudyRoutes {
  static Response post(const RequestContext& context);
  static Response list(const RequestContext& context);
  static Response get(const RequestContext& context);
  static Response erase(const RequestContext& context);
  static Response get_results(const RequestContext& context);
  static Response get_signals(const RequestContext& context);
  static Response get_events(const RequestContext& context);
  static Response cancel(const RequestContext& context);
  static Response retry(const RequestContext& context);
};

using SearchRoutes = StudyRoutes<jobs::StudyKind::kSearch>;
using WearRoutes = StudyRoutes<jobs::StudyKind::kWear>;
using OptimisationRoutes = StudyRoutes<jobs::StudyKind::kOptimisation>;
using FitRoutes = StudyRoutes<jobs::StudyKind::kFit>;

}  // namespace server
