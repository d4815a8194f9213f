// The fast recursions against the paper's own form of the equations, and accelerations against the forces that make them.

#include <random>

#include <gtest/gtest.h>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/dynamics/tree_dynamics.h"
#include "engine/model/rpsup.h"
#include "tests/support/trace_form.h"

namespace engine {
namespace {

struct TreeCase {
  const char* name;
  Coupler coupler;
  int n_rfe;
};
void PrintTo(const TreeCase& c, std::ostream* out) { *out << c.name; }

Mechanism build(const TreeCase& c) {
  RpsupParameters parameters;
  parameters.coupler = c.coupler;
  parameters.rigid_elements = c.n_rfe;
  parameters.guide_offset_y = 0.03;
  return build_rpsup(parameters).mechanism;
}

Eigen::VectorXd random_vector(std::mt19937_64& random, Eigen::Index size, double scale) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  Eigen::VectorXd v(size);
  for (double& x : v) x = uniform(random);
  return v;
}

class TreeForms : public testing::TestWithParam<TreeCase> {};

TEST_P(TreeForms, EqualThePapersTraces) {
  const Mechanism mechanism = build(GetParam());
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  TreeDynamics tree(mechanism);
  std::vector<FrameMotion> frames(mechanism.coordinates.size());
  std::mt19937_64 random(7);
  for (int state = 0; state < 100; ++state) {
    const Eigen::VectorXd q = random_vector(random, n, 1.5);
    const Eigen::VectorXd qd = random_vector(random, n, 10.0);
    calc_frame_motions(mechanism, q, qd, Eigen::VectorXd::Zero(n), frames);
    tree.calc(frames);
    const support::TraceForm paper = support::calc_trace_form(mechanism, q, qd);

    const Eigen::MatrixXd lower = tree.M().triangularView<Eigen::Lower>();
    const Eigen::MatrixXd paper_lower = paper.M.triangularView<Eigen::Lower>();
    // Both forms lose a few roundings of the largest entry: 16 digits less the sums over at most 14 bodies.
    EXPECT_LT((lower - paper_lower).cwiseAbs().maxCoeff(), 1e-13 * paper.M.cwiseAbs().maxCoeff());
    const Eigen::VectorXd bias = paper.h + paper.g;
    EXPECT_LT((tree.bias() - bias).cwiseAbs().maxCoeff(), 1e-12 * bias.cwiseAbs().maxCoeff());
    EXPECT_NEAR(calc_kinetic_energy(mechanism, frames), paper.kinetic_energy, 1e-13 * paper.kinetic_energy);
    double springs = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) springs += 0.5 * mechanism.coordinates[static_cast<std::size_t>(i)].stiffness * q[i] * q[i];
    EXPECT_NEAR(calc_potential_energy(mechanism, frames, q) - springs, paper.potential_energy, 1e-12 * (springs + 10.0));
  }
}

INSTANTIATE_TEST_SUITE_P(Couplers, TreeForms,
                         testing::Values(TreeCase{"rigid", Coupler::kRigid, 4}, TreeCase{"flexible_2", Coupler::kFlexible, 2},
                                         TreeCase{"flexible_4", Coupler::kFlexible, 4}, TreeCase{"flexible_7", Coupler::kFlexible, 7}),
                         [](const auto& c) { return c.param.name; });

/// A state near the assembled one with the journal off centre, so that rings touch.
Eigen::VectorXd touching_state(const Mechanism& mechanism, const MotionSystem& system, std::mt19937_64& random) {
  Evaluation assembled = system.make_evaluation();
  EXPECT_TRUE(LoopClosure(mechanism).assemble(0.0, assembled));
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  Eigen::VectorXd q = assembled.q + random_vector(random, n, 2e-5);
  q[2] += 0.6e-3;  // psi lifts the coupler's end by 0.3 mm: beyond the clearance of 0.25 mm
  Eigen::VectorXd qd = random_vector(random, n, 0.1);
  qd[2] += 1.0;  // towards the bore: a fresh contact that parts has no force left
  return system.make_state(q, qd);
}

// M qdd + h + g + s_f = c + drive forces, with c found from the virtual work of the contact wrench by finite differences of poses.
TEST_P(TreeForms, AccelerationsBalanceContactSpringsAndDrives) {
  const Mechanism mechanism = build(GetParam());
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  MotionSystem system(mechanism);
  Evaluation at = system.make_evaluation();
  std::mt19937_64 random(11);
  for (int state = 0; state < 5; ++state) {
    const Eigen::VectorXd y = touching_state(mechanism, system, random);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(y.size());
    ASSERT_EQ(system.calc_derivative(0.01, y, f, at), EvaluationStatus::kOk);
    ASSERT_GT(at.joints[0].load.radial_normal_sum, 1.0);

    const support::TraceForm paper = support::calc_trace_form(mechanism, at.q, at.qd);
    Eigen::VectorXd needed = paper.M * at.qdd + paper.h + paper.g;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Coordinate& c = mechanism.coordinates[static_cast<std::size_t>(i)];
      needed[i] += c.stiffness * at.q[i] + c.damping * at.qd[i];
    }
    needed[mechanism.drives[0].coordinate] -= at.drive_force[0];
    needed[mechanism.drives[1].coordinate] -= at.drive_force[1];

    // Power of the contact wrench for a unit rate of each coordinate alone: force . v_rel + moment . w_rel in the bearing frame.
    std::vector<FrameMotion> frames(mechanism.coordinates.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      calc_frame_motions(mechanism, at.q, Eigen::VectorXd::Unit(n, i), Eigen::VectorXd::Zero(n), frames);
      const FrameMotion b = calc_bearing_motion(mechanism, mechanism.cut_joints[0], frames);
      const FrameMotion j = calc_journal_motion(mechanism, mechanism.cut_joints[0], frames);
      const Eigen::Vector3d v = b.R.transpose() * (j.v - b.v - b.w.cross(j.p - b.p));
      const Eigen::Vector3d w = b.R.transpose() * (j.w - b.w);
      const ContactLoad& load = at.joints[0].load;
      const double c_i = load.force.dot(v) + load.moment.dot(w);
      EXPECT_NEAR(needed[i], c_i, 1e-11 * (1.0 + load.force.norm())) << mechanism.coordinates[static_cast<std::size_t>(i)].name;
    }
  }
}

}  // namespace
}  // namespace engine
