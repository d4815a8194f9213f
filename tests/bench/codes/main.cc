// SPDX-License-Identifier: Apache-2.0
// One job in this program, in MuJoCo and in Simbody, by turns in one run.
//   bench_codes [REPEATS]
//   bench_codes mujoco      only the processor time of MuJoCo's RK4 run of the rigid job, [s]
// Fails if a code's peak is off by more than its method allows: a comparison of unequal physics is worth
// nothing.

#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/dynamics/dynamics_kernel.h"
#include "tests/bench/codes/contest.h"
#include "tests/bench/codes/large_linkages.h"
#include "tests/bench/codes/make_plain_linkage.h"
#include "tests/bench/codes/mujoco_linkage.h"
#include "tests/bench/codes/our_jobs.h"
#include "tests/bench/codes/simbody_linkage.h"
#include "tests/bench/support/cases.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/table.h"

namespace bench {
namespace {

using engine::Coupler;
using engine::RpsupParameters;
using engine::RunOptions;

constexpr double kDuration = 4.0;  // [s]
constexpr double kStep = 1e-5;     // of MuJoCo's integrators in the ratios asked for, [s]
constexpr int kTreeBodies = 100, kChainLoops = 10;
constexpr const char *kTree = "tree of 100 bodies", *kChain = "chain of 10 loops";

/// A run of a linkage that is made before.
template <typename Run>
std::function<CodeRun()> with(PlainLinkage made, const Run& run) {
  return [plain = std::make_shared<const PlainLinkage>(std::move(made)), run] { return run(*plain); };
}

/// @param step  [s]
Competitor mujoco(const RpsupParameters& parameters, MujocoIntegrator integrator, double step,
                  double accuracy, std::optional<double> wanted_ratio) {
  const std::string method = integrator == MujocoIntegrator::kEuler ? "Euler " : "RK4 ";
  return {"MuJoCo, " + method + digits(step, 2) + " s", accuracy, wanted_ratio, [=] {
            return with(make_plain_linkage(parameters), [=](const PlainLinkage& plain) {
              return run_mujoco(plain, integrator, step, kDuration);
            });
          }};
}

/// @param accuracy  Simbody's
Competitor simbody(const RpsupParameters& parameters, double accuracy, std::optional<double> wanted_ratio) {
  return {"Simbody, Merson " + digits(accuracy, 2), 1e-3, wanted_ratio, [=] {
            return with(make_plain_linkage(parameters), [accuracy](const PlainLinkage& plain) {
              return run_simbody(plain, accuracy, kDuration);
            });
          }};
}

/// The other codes' peaks are measured against this one, too.
RunOptions tight(double duration) {
  return {.duration = duration,
          .integrator = engine::Integrator::kDopri5,
          .relative_tolerance = 1e-8,
          .absolute_tolerance = 1e-9};
}

engine::FrameIndex find_coordinate(const engine::Mechanism& mechanism, const std::string& name) {
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i)
    if (mechanism.coordinates[i].name == name) return static_cast<engine::FrameIndex>(i);
  throw std::invalid_argument("no coordinate " + name);
}

struct Method {
  std::string name;
  RunOptions options;
};

/// Ours: what a job takes if nothing else is asked for, and the explicit method.
std::vector<Method> our_methods() {
  return {{"default integrator", {.duration = kDuration}},
          {"dopri5 1e-6",
           {.duration = kDuration,
            .integrator = engine::Integrator::kDopri5,
            .relative_tolerance = 1e-6,
            .absolute_tolerance = 1e-6}}};
}

Contest make_contest(const std::string& title, const Method& method, const RpsupParameters& parameters,
                     std::vector<Competitor> rivals) {
  return {title,
          "slider acceleration [m/s^2]",
          [=] { return run_rpsup(parameters, tight(kDuration)); },
          {"rpsup, " + method.name,
           1e-3,
           {},
           [=] { return [=] { return run_rpsup(parameters, method.options); }; }},
          std::move(rivals)};
}

// After the settings whose ratios were asked for, each code has the loosest of 1, 2, 4 and 8 times a power of
// ten with which the peak is right to 0.1 %.

Contest make_rigid_contest(const Method& method) {
  const RpsupParameters parameters = linkage(Coupler::kRigid, 0.25e-3, 10.0);
  return make_contest("rigid, 0.25 mm, 10 rad/s, 4 s", method, parameters,
                      {mujoco(parameters, MujocoIntegrator::kEuler, kStep, 5e-3, 10.0),
                       mujoco(parameters, MujocoIntegrator::kRk4, kStep, 1e-3, 35.0),
                       mujoco(parameters, MujocoIntegrator::kRk4, 4e-5, 1e-3, {}),
                       simbody(parameters, 1e-6, 70.0), simbody(parameters, 1e-4, {})});
}

Contest make_flexible_contest(const Method& method) {
  const RpsupParameters parameters = linkage(Coupler::kFlexible, 0.25e-3, 10.0);
  return make_contest("flexible, 0.25 mm, 10 rad/s, 4 s", method, parameters,
                      {mujoco(parameters, MujocoIntegrator::kRk4, kStep, 1e-3, 30.0),
                       mujoco(parameters, MujocoIntegrator::kRk4, 4e-5, 1e-3, {}),
                       simbody(parameters, 2e-2, {})});
}

/// A described linkage without contacts.
/// @param step, simbody_accuracy  of MuJoCo's RK4, [s], and of Simbody: the largest of 1, 2, 4 and 8 times a
/// power of ten with which the peak holds
Contest make_large_contest(const std::string& title, const LargeLinkage& large, double step,
                           double simbody_accuracy) {
  constexpr double kShort = 2.0;  // [s]
  const auto built = std::make_shared<engine::BuiltLinkage>(engine::build_linkage(large.linkage));
  const auto plain = [=] {
    return make_plain_linkage(built->mechanism, find_coordinate(built->mechanism, large.measured));
  };
  const auto ours = [=](const RunOptions& options) {
    return [=] { return run_linkage(large.linkage, large.measured, options); };
  };
  return {title,
          "acceleration [rad/s^2]",
          ours(tight(kShort)),
          {"rpsup, default integrator", 1e-3, {}, [=] { return ours({.duration = kShort}); }},
          {{"rpsup, 10 Hz of output",
            1e-3,
            {},
            [=] { return ours({.duration = kShort, .output_rate = 10.0}); }},
           {"MuJoCo, RK4 " + digits(step, 2) + " s",
            1e-3,
            {},
            [=] {
              return with(plain(), [step](const PlainLinkage& made) {
                return run_mujoco(made, MujocoIntegrator::kRk4, step, kShort);
              });
            }},
           {"Simbody, Merson " + digits(simbody_accuracy, 2), 1e-3, {}, [=] {
              return with(plain(), [simbody_accuracy](const PlainLinkage& made) {
                return run_simbody(made, simbody_accuracy, kShort);
              });
            }}}};
}

void print_evaluations() {
  std::cout << "\nOne evaluation of the equations of motion, every ring in contact\n\n";
  Table table({"linkage", "rpsup [us]", "baseline [us]", "MuJoCo [us]", "Simbody [us]", "MuJoCo / rpsup",
               "MuJoCo / baseline", "Simbody / rpsup", "Simbody / baseline"});
  const auto add = [&table](const char* name, const std::function<double(std::string_view)>& time_ours,
                            const std::function<PlainLinkage()>& plain) {
    const double ours = time_ours({}), baseline = time_ours(engine::instruction_sets().front());
    const double mujoco = time_mujoco_evaluation(plain());
    const double simbody = time_simbody_evaluation(plain());
    table.add({name, digits(1e6 * ours, 3), digits(1e6 * baseline, 3), digits(1e6 * mujoco, 3),
               digits(1e6 * simbody, 3), digits(mujoco / ours, 3), digits(mujoco / baseline, 3),
               digits(simbody / ours, 3), digits(simbody / baseline, 3)});
  };
  for (const Coupler coupler : {Coupler::kRigid, Coupler::kFlexible}) {
    const RpsupParameters parameters = linkage(coupler, 0.25e-3, 10.0);
    add(coupler == Coupler::kRigid ? "rigid" : "flexible",
        [&](std::string_view set) { return time_rpsup_evaluation(parameters, set); },
        [&] { return make_plain_linkage_in_contact(parameters); });
  }
  for (const auto& [name, large] :
       {std::pair{kTree, make_tree(kTreeBodies)}, std::pair{kChain, make_chain(kChainLoops)}}) {
    const engine::BuiltLinkage built = engine::build_linkage(large.linkage);
    add(name, [&](std::string_view set) { return time_evaluation(built.mechanism, set); },
        [&] { return make_plain_linkage(built.mechanism, 0); });
  }
  table.print(std::cout);
}

/// The rigid linkage is solved instant by instant, whatever the integrator.
void print_ideal_jobs(int repeats) {
  std::cout << "\nJobs with an ideal joint, 10 rad/s, 4 s, 1 kHz of output\n\n";
  Table table({"coupler", "method", "CPU median [ms/s]", "at most", "met"});
  const std::vector<Method> methods = our_methods();
  const auto add = [&](const char* name, Coupler coupler, const Method& method, double limit) {
    Samples samples;
    for (int i = 0; i < 3 * repeats; ++i)
      samples.add(1e3 / kDuration *
                  time_cpu([&] { (void)run_rpsup(linkage(coupler, 0.0, 10.0), method.options); }));
    table.add({name, method.name, digits(samples.median(), 3), digits(limit, 3),
               samples.median() < limit ? "yes" : "no"});
  };
  add("rigid", Coupler::kRigid, methods.front(), 5.0);
  for (const Method& method : methods) add("flexible", Coupler::kFlexible, method, 10.0);
  table.print(std::cout);
}

void print_mujoco_time() {
  const RpsupParameters rigid = linkage(Coupler::kRigid, 0.25e-3, 10.0);
  const auto run = mujoco(rigid, MujocoIntegrator::kRk4, kStep, 1.0, {}).prepare();
  std::cout << digits(time_cpu([&run] { (void)run(); }), 6) << '\n';
}

int run(int repeats) {
  print_evaluations();
  print_ideal_jobs(repeats);
  std::vector<Contest> contests;
  for (const Method& method : our_methods()) {
    contests.push_back(make_rigid_contest(method));
    contests.push_back(make_flexible_contest(method));
  }
  bool fair = true;
  const auto hold = [&fair](Contest& contest, int times) {
    contest.run(times);
    contest.print(std::cout);
    fair = fair && contest.is_fair();
  };
  for (Contest& contest : contests) hold(contest, repeats);
  constexpr int kOfShortRuns = 5;
  for (Contest contest : {make_large_contest(kTree, make_tree(kTreeBodies), 2e-2, 1e-3),
                          make_large_contest(kChain, make_chain(kChainLoops), 8e-4, 4e-5)})
    hold(contest, kOfShortRuns * repeats);
  if (!fair) std::cerr << "bench_codes: a code's peak is off: what is compared is not the same\n";
  return fair ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  try {
    if (argc == 2 && std::string_view(argv[1]) == "mujoco") {
      bench::print_mujoco_time();
      return EXIT_SUCCESS;
    }
    const int repeats = argc > 1 ? std::atoi(argv[1]) : 3;
    if (argc > 2 || repeats < 1) {
      std::cerr << "usage: bench_codes [REPEATS | mujoco]\n";
      return 2;
    }
    return bench::run(repeats);
  } catch (const std::exception& error) {
    std::cerr << "bench_codes: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
