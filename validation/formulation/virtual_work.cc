// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "validation/formulation/parts.h"
#include "validation/reference/contact_points.h"
#include "validation/reference/paper_linkage.h"
#include "validation/reference/trace_form.h"
#include "validation/support/differences.h"
#include "validation/support/largest.h"
#include "validation/support/text.h"

namespace validation {

namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kWorkStates = 10;
constexpr double kWorkStep = 0.03;  // [rad] and [m], of the differences
constexpr double kMultiplierBound = 1e-11;  // that of the trace form's terms

/// Poses of bearing and journal in the paper's chains, with their derivatives by the coordinates.
class JointPoses {
 public:
  explicit JointPoses(const RpsupParameters& p)
      : chains_(make_paper_chains(p)), journal_frame_(size() - 1), bearing_frame_(size() - 3) {
    B_(0, 3) = calc_bearing_x(p);
  }

  [[nodiscard]] const Mechanism& chains() const { return chains_; }
  [[nodiscard]] FrameTransforms bearing(const VectorXd& q) const {
    FrameTransforms b = calc_transforms(chains_, bearing_frame_, q);
    b.T = b.T * B_;
    for (Matrix4d& T_i : b.T_i) T_i = T_i * B_;
    return b;
  }
  [[nodiscard]] FrameTransforms journal(const VectorXd& q) const {
    return calc_transforms(chains_, journal_frame_, q);
  }

  /// The journal as the bearing sees it.
  [[nodiscard]] Matrix4d relative(const VectorXd& q) const { return bearing(q).T.inverse() * journal(q).T; }

 private:
  [[nodiscard]] FrameIndex size() const { return static_cast<FrameIndex>(chains_.coordinates.size()); }

  Mechanism chains_;
  FrameIndex journal_frame_, bearing_frame_;
  Matrix4d B_ = Matrix4d::Identity();  ///< the bearing in its frame
};

/// A state near the assembled one with the journal off centre: rings and faces touch.
VectorXd draw_touching_state(const Mechanism& mechanism, const MotionSystem& system, Random& random) {
  Evaluation assembled = system.make_evaluation();
  if (!LoopClosure(mechanism).assemble(0.0, assembled))
    throw std::runtime_error("the linkage of the virtual-work part cannot be assembled");
  VectorXd q = assembled.q + random.symmetric_vector(assembled.q.size(), 2e-5);
  const Eigen::Index slider = q.size() - 2;
  // the guide lies across the bore's axis, or nearly so: the journal moves beyond the clearance of 0.25 mm
  q[slider] += 0.36e-3;
  VectorXd qd = random.symmetric_vector(q.size(), 0.1);
  qd[slider] += 0.5;  // towards the bore
  return system.make_state(q, qd);
}

/// c = M qdd + h + g + s_f less the drives' forces, with the engine's accelerations and drive forces.
VectorXd calc_needed_contact_forces(const RpsupParameters& parameters, const Mechanism& chains,
                                    const Mechanism& mechanism, const Evaluation& at) {
  const TraceForm paper = calc_trace_form(chains, at.q, at.qd);
  VectorXd needed = paper.M * at.qdd + paper.h + paper.g + calc_elastic_terms(parameters, at.q, at.qd).s_f;
  for (std::size_t k = 0; k < mechanism.drives.size(); ++k)
    needed[mechanism.drives[k].coordinate] -= at.drive_force[static_cast<Eigen::Index>(k)];
  return needed;
}

/// Eq. (12): every point's force times the derivative of the point by the coordinate, on bearing and journal.
VectorXd calc_paper_contact_forces(const RpsupParameters& parameters, const JointPoses& poses,
                                   const Evaluation& at) {
  const FrameTransforms b = poses.bearing(at.q);
  const FrameTransforms j = poses.journal(at.q);
  const auto rate_of = [&](const FrameTransforms& part) {
    Matrix4d T_d = Matrix4d::Zero();
    for (std::size_t i = 0; i < part.T_i.size(); ++i)
      T_d += part.T_i[i] * at.qd[static_cast<Eigen::Index>(i)];
    return T_d;
  };
  VectorXd c = VectorXd::Zero(at.q.size());
  for (const ContactPoint& point : find_fresh_contacts(parameters, {b.T, rate_of(b)}, {j.T, rate_of(j)})) {
    const Eigen::Vector4d in_b = b.T.inverse() * point.p_W.homogeneous();
    const Eigen::Vector4d in_j = j.T.inverse() * point.p_W.homogeneous();
    for (Eigen::Index i = 0; i < c.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      c[i] += point.force_W.dot((j.T_i[k] * in_j).head<3>()) - point.force_W.dot((b.T_i[k] * in_b).head<3>());
    }
  }
  return c;
}

/// Work of the engine's contact force and moment when one coordinate alone is moved: how the journal moves in
/// the bearing, by differences.
VectorXd calc_virtual_work(const JointPoses& poses, const Evaluation& at) {
  const ContactLoad& load = at.joints[0].load;
  const Matrix3d R = poses.relative(at.q).topLeftCorner<3, 3>();
  VectorXd work(at.q.size());
  for (Eigen::Index i = 0; i < work.size(); ++i) {
    const Matrix4d slope = first_derivative(
        [&](double s) { return poses.relative(at.q + s * VectorXd::Unit(at.q.size(), i)); }, kWorkStep);
    const Matrix3d turn = slope.topLeftCorner<3, 3>() * R.transpose();
    work[i] = load.force.dot(slope.topRightCorner<3, 1>()) +
              load.moment.dot(Vector3d(turn(2, 1), turn(0, 2), turn(1, 0)));
  }
  return work;
}

/// Phi_q of the ideal joint, 5 rows: p_j - p_b, z_b . x_j, z_b . y_j, by the trace form's derivatives.
Eigen::MatrixXd calc_joint_slopes(const JointPoses& poses, const VectorXd& q) {
  const FrameTransforms b = poses.bearing(q);
  const FrameTransforms j = poses.journal(q);
  Eigen::MatrixXd slopes(5, q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    slopes.col(i).head<3>() = (j.T_i[k] - b.T_i[k]).topRightCorner<3, 1>();
    for (const int axis : {0, 1})
      slopes(3 + axis, i) = b.T_i[k].col(2).dot(j.T.col(axis)) + b.T.col(2).dot(j.T_i[k].col(axis));
  }
  return slopes;
}

/// Of an ideal joint, near its assembled state.
struct MultiplierDifferences {
  Largest terms;      ///< of M qdd + h + g + s_f - drives from any Phi_q^T lambda, relative
  Largest reaction;   ///< of the engine's reaction from lambda's force, relative
};

MultiplierDifferences compare_multipliers(RpsupParameters parameters) {
  parameters.c_r = 0.0;
  const Mechanism mechanism = build_rpsup(parameters).mechanism;
  const JointPoses poses(parameters);
  MotionSystem system(mechanism);
  Evaluation assembled = system.make_evaluation();
  if (!LoopClosure(mechanism).assemble(0.0, assembled))
    throw std::runtime_error("the ideal linkage of the virtual-work part cannot be assembled");
  Evaluation at = system.make_evaluation();
  Random random(13);
  MultiplierDifferences worst;
  for (int k = 0; k < kWorkStates; ++k) {
    const VectorXd q = assembled.q + random.symmetric_vector(assembled.q.size(), 1e-3);
    const VectorXd y = system.make_state(q, random.symmetric_vector(q.size(), 1.0));
    VectorXd rates = VectorXd::Zero(y.size());
    if (system.calc_derivative(0.01, y, rates, at) != EvaluationStatus::kOk)
      throw std::runtime_error("a state of an ideal joint cannot be evaluated");
    const VectorXd needed = calc_needed_contact_forces(parameters, poses.chains(), mechanism, at);
    const Eigen::MatrixXd slopes_t = calc_joint_slopes(poses, at.q).transpose();
    const VectorXd lambda = slopes_t.colPivHouseholderQr().solve(needed);
    worst.terms.take(relative_difference(needed, slopes_t * lambda));
    worst.reaction.take(relative_difference(at.joints[0].reaction_W, lambda.head<3>()));
  }
  return worst;
}

struct WorkDifferences {
  Largest virtual_work, paper;
};

WorkDifferences compare_contact_forces(const RpsupParameters& parameters) {
  const Mechanism mechanism = build_rpsup(parameters).mechanism;
  const JointPoses poses(parameters);
  MotionSystem system(mechanism);
  Evaluation at = system.make_evaluation();
  Random random(11);
  WorkDifferences worst;
  for (int k = 0; k < kWorkStates; ++k) {
    const VectorXd y = draw_touching_state(mechanism, system, random);
    VectorXd rates = VectorXd::Zero(y.size());
    if (system.calc_derivative(0.01, y, rates, at) != EvaluationStatus::kOk)
      throw std::runtime_error("a touching state cannot be evaluated");
    if (!(at.joints[0].load.radial_normal_sum > 100.0))
      throw std::runtime_error("a touching state does not touch");
    const VectorXd needed = calc_needed_contact_forces(parameters, poses.chains(), mechanism, at);
    worst.virtual_work.take(relative_difference(needed, calc_virtual_work(poses, at)));
    worst.paper.take(relative_difference(needed, calc_paper_contact_forces(parameters, poses, at)));
  }
  return worst;
}

}  // namespace

Findings compute_virtual_work() {
  Findings findings;
  for (CouplerCase c : coupler_cases()) {
    std::string faces;
    if (c.parameters.coupler == Coupler::kFlexible && c.parameters.rigid_elements == 4) {
      c.parameters.axial_levels = 2;
      c.parameters.axial_elements = 5;
      faces = ", faces with 2 circles of 5 points";
    }
    for (const DriveEnforcement drive : {DriveEnforcement::kPrescribed, DriveEnforcement::kBaumgarte}) {
      c.parameters.drive = drive;
      const WorkDifferences worst = compare_contact_forces(c.parameters);
      const std::string of =
          ", " + c.name +
          (drive == DriveEnforcement::kPrescribed ? ", drives prescribed" : ", drives by multipliers");
      const std::string at = of + faces + ", 10 states in contact";
      findings.checks.push_back(
          limit("c = M qdd + h + g + s_f less drive torque and force" + at,
                "virtual work of the contact force and moment at each coordinate, central differences of "
                "order 8 over " +
                    number(kWorkStep) + " rad or m of the trace form's poses",
                worst.virtual_work.value(), 1e-11, "1",
                "relative to the largest entry of c; poses round at 2e-16, over the step 2e-14"));
      findings.checks.push_back(
          limit("c = M qdd + h + g + s_f less drive torque and force, with the contacts found anew" + at,
                "Eq. (12) with the forces of Eqs. (10), (11), some hundred N and more, and the "
                "trace form's derivatives of the contact points",
                worst.paper.value(), 1e-10, "1",
                "relative to the largest entry of c; positions near 1 m round at 2e-16 m, and penetrations "
                "of 1e-5 m "
                "with them"));
      const MultiplierDifferences ideal = compare_multipliers(c.parameters);
      const std::string at_ideal = of + ", ideal joint, 10 states near the assembled one";
      findings.checks.push_back(limit(
          "M qdd + h + g + s_f less drive torque and force" + at_ideal,
          "Phi_q^T lambda with the trace form's slopes Phi_q of the joint's five rows and the lambda nearest "
          "to it",
          ideal.terms.value(), kMultiplierBound, "1",
          "relative to the largest entry: rounding, and a system of the joint's and drives' multipliers"));
      findings.checks.push_back(limit("reaction of the joint" + at_ideal, "the same lambda's force",
                                      ideal.reaction.value(), kMultiplierBound, "1",
                                      "relative to its largest component: rounding, and a system of the "
                                      "joint's and drives' multipliers"));
    }
  }
  return findings;
}

}  // namespace validation
