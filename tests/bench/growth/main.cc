// SPDX-License-Identifier: Apache-2.0
// Growth of the cost with the elements of the coupler and with those of the contact.
//   bench_growth [SECONDS]   processor time spent on each run at most, 30 by default

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/simulate_rpsup.h"
#include "tests/bench/support/contact_state.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/table.h"

namespace bench {
namespace {

using engine::Coupler;
using engine::RpsupParameters;

constexpr int kRounds = 3;

struct Cost {
  double evaluation;     ///< of the equations of motion in contact, [s]
  double per_simulated;  ///< processor time of a simulated second
  double simulated;      ///< how much was, [s]
};

/// A job of four seconds, or as much of it as the time allows.
Cost measure(const RpsupParameters& parameters, double budget) {
  constexpr double kDuration = 4.0;
  ContactState state(parameters);
  Cost cost{time_short([&state] { state.evaluate(); }), 0.0, 0.0};
  const double start = cpu_seconds();
  const engine::RunResult run = engine::simulate_rpsup(
      parameters, {.duration = kDuration}, [=](double) { return cpu_seconds() - start > budget; });
  if (run.status != engine::RunStatus::kSucceeded && run.status != engine::RunStatus::kStopped)
    throw std::runtime_error(run.detail);
  cost.simulated = run.t_end;
  cost.per_simulated = (cpu_seconds() - start) / run.t_end;
  return cost;
}

/// A shared machine has slow moments, and no fast ones.
Cost least(const Cost& a, const Cost& b) {
  return {std::min(a.evaluation, b.evaluation), std::min(a.per_simulated, b.per_simulated),
          std::min(a.simulated, b.simulated)};
}

/// Each count has its turn in each round; of its costs the least stands.
void print_growth(const char* title, const char* name, const std::vector<int>& counts, double budget,
                  const std::function<RpsupParameters(int)>& with) {
  std::cout << '\n' << title << "\n\n";
  Table table({name, "evaluation [us]", "to the first", "count to the first", "CPU of a simulated second [s]",
               "to the first", "simulated [s]"});
  std::vector<Cost> costs(counts.size());
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const Cost cost = measure(with(counts[k]), budget);
      costs[k] = round == 0 ? cost : least(costs[k], cost);
    }
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const Cost& cost = costs[k];
    table.add({std::to_string(counts[k]), digits(1e6 * cost.evaluation, 3),
               digits(cost.evaluation / costs[0].evaluation, 3),
               digits(static_cast<double>(counts[k]) / counts[0], 3), digits(cost.per_simulated, 3),
               digits(cost.per_simulated / costs[0].per_simulated, 3), digits(cost.simulated, 2)});
  }
  table.print(std::cout);
}

void print_all(double budget) {
  print_growth("Flexible coupler, 0.25 mm, 5 rad/s, default integrator", "n_rfe", {4, 8, 16, 32, 64}, budget,
               [](int count) {
                 RpsupParameters parameters = linkage(Coupler::kFlexible, 0.25e-3, 5.0);
                 parameters.rigid_elements = count;
                 return parameters;
               });
  print_growth("Contact elements, rigid coupler, 0.25 mm, 10 rad/s, default integrator", "radial_elements",
               {36, 180, 360, 720, 1440}, budget, [](int count) {
                 RpsupParameters parameters = linkage(Coupler::kRigid, 0.25e-3, 10.0);
                 parameters.contact = engine::ContactForm::kElements;
                 parameters.radial_elements = count;
                 return parameters;
               });
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  try {
    const double budget = argc > 1 ? std::atof(argv[1]) : 30.0;
    if (argc > 2 || !(budget > 0.0)) {
      std::cerr << "usage: bench_growth [SECONDS]\n";
      return 2;
    }
    bench::print_all(budget);
  } catch (const std::exception& error) {
    std::cerr << "bench_growth: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
