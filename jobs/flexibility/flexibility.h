// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"

namespace jobs {

/// Comparison of a flexible link with a rigid one: a row for each combination of the parameters that a sweep
/// varies beside the link, in which its rigid and its flexible jobs stand side by side. The link is the
/// coupler, or a beam of a described linkage whose `elements` are 1, rigid, and another number.
///
/// `ratio` is the flexible mean of the metric over the rigid one; with replicates it lies between
/// `ratio_least` (the least flexible value over the largest rigid one) and `ratio_largest`. `verdict` is
/// "helps" if even the largest is below 0.999, "harms" if even the least is above 1.001, else "either": peaks
/// are no better than that. Without replicates of both it is "one_run_each": nobody knows their scatter.
/// `reverses_from` is the last value of `along`, the first number that is swept, before this one with a
/// verdict "helps" or "harms", if that was the other one, all else equal. `coupler_loss_j` is the
/// structural loss of the flexible jobs, of all flexible links, dampers and motors, `coupler_loss_part` its
/// part of all losses.
/// @throws InvalidRequest ("/metric"); WrongState if the sweep varies no such link
[[nodiscard]] ResultTable compare_links(const nlohmann::json& sweep, const ResultTable& results,
                                        const std::string& metric);

}  // namespace jobs
