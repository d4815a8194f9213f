// SPDX-License-Identifier: Apache-2.0
#include "validation/reference/trace_form.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/dynamics/inverse_dynamics.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "validation/formulation/parts.h"
#include "validation/reference/paper_linkage.h"
#include "validation/support/largest.h"
#include "validation/support/mass_matrix.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr int kTraceStates = 1000;

/// Compared quantity, its equations, and the reason for its bound.
struct Quantity {
  const char* name;
  const char* symbol;
  const char* equations;
  const char* why;
};
enum Index : std::size_t {
  kMass,
  kCoriolis,
  kGravity,
  kBias,
  kKinetic,
  kPotential,
  kMotion,
  kPrescribed,
  kMultipliers,
  kDriveLaws,
  kSprings,
  kDampers,
  kDissipation,
  kQuantities
};
constexpr const char* kRounding = "both forms round, in sums over up to 34 coordinates and 14 bodies";
constexpr const char* kBackward =
    "both forms round, relative to the largest row of |M| |qdd|: thin elements turn at up to 3e11 rad/s^2, "
    "and such terms cancel";
constexpr const char* kEnforced =
    "rounding, and a system of two multipliers that undo what bodies and springs would do to crank and rod; "
    "relative to the larger of the two";
constexpr const char* kHeavy =
    "rounding; a body of 1 kg and 1 kg m^2 in place of every link and element keeps the accelerations small, "
    "so that they show the last "
    "digits of s_f";
constexpr std::array<Quantity, kQuantities> kCompared{{
    {"mass matrix M", "M", "Eq. (5)", kRounding},
    {"Coriolis and centrifugal terms h", "h", "Eq. (5)", kRounding},
    {"gravity terms g", "g", "Eq. (7)", kRounding},
    {"h + g in one sweep", "h + g", "Eqs. (5), (7)", kRounding},
    {"kinetic energy", "T", "Eq. (4)", kRounding},
    {"potential energy of gravity and springs", "V", "Eqs. (6), (8.1)", kRounding},
    {"accelerations of the free chains, M qdd + h + g + s_f = 0", "M qdd + h + g + s_f",
     "Eqs. (5), (7), (9), (13.2)", kBackward},
    {"accelerations and drive forces, prescribed drives, M qdd + h + g + s_f = drives",
     "M qdd + h + g + s_f - drives, prescribed", "Eqs. (5), (7), (9), (13.2)", kBackward},
    {"accelerations and drive forces, drives by multipliers, M qdd + h + g + s_f = drives",
     "M qdd + h + g + s_f - drives, multipliers", "Eqs. (5), (7), (9), (13.2)", kBackward},
    {"accelerations of crank and rod, drives by multipliers", "qdd of the drives, multipliers",
     "the drive laws with Baumgarte's terms", kEnforced},
    {"spring part of s_f", "s_f, springs", "Eqs. (8.1), (9) with S = diag(E I, E I, G J) / dl", kHeavy},
    {"damper part of s_f", "s_f, dampers", "Eqs. (8.2), (9) with D = 2 zeta / omega_1 S", kHeavy},
    {"power lost in the dampers", "2 R", "twice R of Eq. (8.2)", kRounding},
}};
constexpr std::size_t kOfRigid = kSprings;  // the quantities from here on belong to a flexible coupler

/// The engine's recursions at one state after the other.
class Engine {
 public:
  explicit Engine(const Mechanism& chains)
      : chains_(chains),
        weightless_(without_gravity(chains)),
        inverse_dynamics_(chains_),
        weightless_dynamics_(weightless_),
        system_(chains_),
        at_(system_.make_evaluation()),
        frames_(chains.coordinates.size()) {}
  Engine(const Engine&) = delete;  // its members refer to each other
  Engine& operator=(const Engine&) = delete;

  [[nodiscard]] Eigen::MatrixXd calc_mass_matrix(const ChainState& state) const {
    return validation::calc_mass_matrix(chains_, state.q);
  }
  [[nodiscard]] const Eigen::VectorXd& calc_bias(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    return calc_forces(chains_, inverse_dynamics_, q, qd);
  }
  [[nodiscard]] const Eigen::VectorXd& calc_weightless_bias(const ChainState& state) {
    return calc_forces(weightless_, weightless_dynamics_, state.q, state.qd);
  }
  /// All of it at once: accelerations, energies, losses.
  [[nodiscard]] const Evaluation& evaluate(const ChainState& state) {
    const Eigen::VectorXd y = system_.make_state(state.q, state.qd);
    rates_.setZero(y.size());
    if (system_.calc_derivative(0.0, y, rates_, at_) != EvaluationStatus::kOk)
      at_.qdd.setConstant(std::nan(""));
    system_.calc_energies(at_);
    return at_;
  }
  [[nodiscard]] double structural_power() const { return rates_[rates_.size() - 1]; }

 private:
  static Mechanism without_gravity(Mechanism chains) {
    chains.gravity_W.setZero();
    return chains;
  }
  const Eigen::VectorXd& calc_forces(const Mechanism& chains, InverseDynamics& inverse_dynamics,
                                     const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    calc_frame_motions(chains, q, qd, Eigen::VectorXd::Zero(q.size()), frames_);
    return inverse_dynamics.calc(frames_);
  }

  Mechanism chains_, weightless_;
  InverseDynamics inverse_dynamics_, weightless_dynamics_;
  MotionSystem system_;
  Evaluation at_;
  Eigen::VectorXd rates_;
  std::vector<FrameMotion> frames_;
};

/// The same chains with heavy bodies, of three different moments, in place of links and elements, and without
/// gravity.
Mechanism with_heavy_bodies(Mechanism chains) {
  chains.gravity_W.setZero();
  for (Coordinate& c : chains.coordinates) {
    if (c.mass == 0.0) continue;
    c.mass = 1.0;
    c.com.setZero();
    c.inertia = Eigen::Vector3d(1.0, 1.25, 1.5).asDiagonal();
  }
  return chains;
}

/// Largest differences over many states.
class Worst {
 public:
  /// Vectors and matrices count relative to their largest entry at the state.
  void take(Index quantity, const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
    take_difference(quantity, relative_difference(found, expected), 1.0);
  }
  /// Scalars count relative to the largest that any state has.
  void take(Index quantity, double found, double expected) {
    take_difference(quantity, std::abs(found - expected), std::abs(expected));
  }
  /// Residuals of equations of motion count relative to the largest row of |M| |qdd| at the state.
  void take_residual(Index quantity, const Eigen::MatrixXd& M, const Eigen::VectorXd& qdd,
                     const Eigen::VectorXd& residual) {
    const Eigen::VectorXd terms = M.cwiseAbs() * qdd.cwiseAbs();
    take_difference(quantity,
                    residual.allFinite() ? residual.cwiseAbs().maxCoeff() / terms.maxCoeff() : std::nan(""),
                    1.0);
  }
  void take_difference(Index quantity, double difference, double scale) {
    differences_[quantity].take(difference);
    largest_[quantity].take(scale);
  }
  [[nodiscard]] double relative(std::size_t quantity) const {
    return differences_[quantity].value() / largest_[quantity].value();
  }

 private:
  std::array<Largest, kQuantities> differences_, largest_;
};

/// M, h, g, energies and accelerations of the chains at the same states in both forms.
void compare_chains(const RpsupParameters& parameters, Worst& worst) {
  Engine engine(open_chains(build_rpsup(parameters).mechanism));
  const Mechanism paper_chains = make_paper_chains(parameters);
  Random random(7);
  for (int k = 0; k < kTraceStates; ++k) {
    const ChainState state = draw_state(paper_chains, random);
    const TraceForm paper = calc_trace_form(paper_chains, state.q, state.qd);
    const ElasticTerms elastic = calc_elastic_terms(parameters, state.q, state.qd);
    worst.take(kMass, engine.calc_mass_matrix(state), paper.M);
    worst.take(kCoriolis, engine.calc_weightless_bias(state), paper.h);
    worst.take(kGravity, engine.calc_bias(state.q, Eigen::VectorXd::Zero(state.q.size())), paper.g);
    worst.take(kBias, engine.calc_bias(state.q, state.qd), paper.h + paper.g);
    const Evaluation& at = engine.evaluate(state);
    worst.take_residual(kMotion, paper.M, at.qdd, paper.M * at.qdd + paper.h + paper.g + elastic.s_f);
    worst.take(kKinetic, at.energy.kinetic, paper.kinetic_energy);
    worst.take(kPotential, at.energy.potential, paper.potential_energy + elastic.energy);
    worst.take(kDissipation, engine.structural_power(), 2.0 * elastic.rayleigh);
  }
}

/// Accelerations and drive forces of the chains with crank and rod driven.
void compare_driven_chains(RpsupParameters parameters, DriveEnforcement drive, Worst& worst) {
  parameters.drive = drive;
  Mechanism chains = build_rpsup(parameters).mechanism;
  chains.cut_joints.clear();
  const Mechanism paper_chains = make_paper_chains(parameters);
  MotionSystem system(chains);
  Evaluation at = system.make_evaluation();
  Eigen::VectorXd rates;
  Random random(9);
  for (int k = 0; k < kTraceStates; ++k) {
    const ChainState state = draw_state(paper_chains, random);
    const double t = std::abs(random.symmetric(parameters.run_up));
    const Eigen::VectorXd y = system.make_state(state.q, state.qd);
    rates.setZero(y.size());
    if (system.calc_derivative(t, y, rates, at) != EvaluationStatus::kOk) at.qdd.setConstant(std::nan(""));
    const TraceForm paper = calc_trace_form(paper_chains, at.q, at.qd);
    Eigen::VectorXd residual =
        paper.M * at.qdd + paper.h + paper.g + calc_elastic_terms(parameters, at.q, at.qd).s_f;
    Eigen::Vector2d found, wanted;
    for (Eigen::Index d = 0; d < 2; ++d) {
      const Drive& driven = chains.drives[static_cast<std::size_t>(d)];
      const FrameIndex i = driven.coordinate;
      const DrivenMotion law = calc_driven_motion(driven.law, t);
      residual[i] -= at.drive_force[d];
      found[d] = at.qdd[i];
      wanted[d] = law.qdd - 2.0 * parameters.baumgarte_alpha * (at.qd[i] - law.qd) -
                  std::pow(parameters.baumgarte_beta, 2) * (at.q[i] - law.q);
    }
    worst.take_residual(drive == DriveEnforcement::kPrescribed ? kPrescribed : kMultipliers, paper.M, at.qdd,
                        residual);
    if (drive == DriveEnforcement::kBaumgarte) worst.take(kDriveLaws, found, wanted);
  }
}

/// s_f as the accelerations show it: without rates that of the springs, in the straight coupler that of the
/// dampers (at low rates, for h grows with their squares).
void compare_elastic_terms(const RpsupParameters& parameters, Worst& worst) {
  Engine engine(with_heavy_bodies(open_chains(build_rpsup(parameters).mechanism)));
  const Mechanism paper_chains = with_heavy_bodies(make_paper_chains(parameters));
  Random random(8);
  for (int k = 0; k < kTraceStates; ++k) {
    const ChainState state = draw_state(paper_chains, random);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(state.q.size());
    ChainState straight = state;
    straight.q.segment(5, state.q.size() - 7).setZero();  // all sde
    straight.qd *= 1e-3;
    const std::array<std::pair<Index, ChainState>, 2> parts{
        {{kSprings, {state.q, zero}}, {kDampers, straight}}};
    for (const auto& [quantity, at] : parts) {
      const TraceForm paper = calc_trace_form(paper_chains, at.q, at.qd);
      const Eigen::VectorXd found = -(paper.M * engine.evaluate(at).qdd + paper.h + paper.g);
      worst.take(quantity, found, calc_elastic_terms(parameters, at.q, at.qd).s_f);
    }
  }
}

}  // namespace

Findings compute_trace_form() {
  Findings findings;
  Table table{.caption =
                  "Engine and trace form at 1,000 random states: largest difference relative to the "
                  "quantity's largest entry.",
              .head = {"quantity"},
              .rows = {},
              .reproducible_to = 10.0};
  for (const Quantity& quantity : kCompared) table.rows.push_back({quantity.symbol});
  for (const CouplerCase& c : coupler_cases()) {
    const bool rigid = c.parameters.coupler == Coupler::kRigid;
    Worst worst;
    compare_chains(c.parameters, worst);
    for (const DriveEnforcement drive : {DriveEnforcement::kPrescribed, DriveEnforcement::kBaumgarte})
      compare_driven_chains(c.parameters, drive, worst);
    if (!rigid) compare_elastic_terms(c.parameters, worst);
    table.head.push_back(c.name);
    for (std::size_t k = 0; k < kQuantities; ++k) {
      const Quantity& quantity = kCompared[k];
      const bool shown = !rigid || k < kOfRigid;
      table.rows[k].push_back(shown ? number(worst.relative(k), 2) : "-");
      if (!shown) continue;
      findings.checks.push_back(limit(std::string(quantity.name) + ", " + c.name + ", 1,000 random states",
                                      std::string("4x4 matrices and traces, ") + quantity.equations,
                                      worst.relative(k), 1e-11, "1", quantity.why));
    }
  }
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace validation
