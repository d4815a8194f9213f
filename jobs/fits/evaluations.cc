// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/evaluations.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/errors.h"

namespace jobs {

void Evaluations::tell(const FitPoint& point, std::vector<double> residuals) {
  engine::require(!residuals.empty(), "residuals", "one or more");
  engine::require(residual_count_ == 0 || residuals.size() == residual_count_, "residuals",
                  "as many as at the other points: " + std::to_string(residual_count_));
  if (!std::ranges::all_of(residuals, [](double r) { return std::isfinite(r); })) return tell_failed(point);
  residual_count_ = residuals.size();
  by_point_.try_emplace(point, std::move(residuals));
}

void Evaluations::tell_failed(const FitPoint& point) { by_point_.try_emplace(point, std::nullopt); }

const std::optional<std::vector<double>>* Evaluations::find(const FitPoint& point) const {
  const auto found = by_point_.find(point);
  return found == by_point_.end() ? nullptr : &found->second;
}

}  // namespace jobs
