#include "engine/dynamics/constraints.h"

#include <cstddef>

namespace engine {

namespace {

FrameMotion calc_end_motion(const Mechanism& mechanism, FrameIndex frame, const Placement& placement, const std::vector<FrameMotion>& frames) {
  return calc_placed_motion(frame == kGround ? ground_motion(mechanism) : frames[static_cast<std::size_t>(frame)], placement);
}

}  // namespace

FrameMotion calc_bearing_motion(const Mechanism& mechanism, const CutJoint& joint, const std::vector<FrameMotion>& frames) {
  return calc_end_motion(mechanism, joint.bearing_frame, joint.bearing, frames);
}

FrameMotion calc_journal_motion(const Mechanism& mechanism, const CutJoint& joint, const std::vector<FrameMotion>& frames) {
  return calc_end_motion(mechanism, joint.journal_frame, joint.journal, frames);
}

Constraints::Constraints(const Mechanism& mechanism) : mechanism_(mechanism) {
  Eigen::Index rows = 0;
  for (const CutJoint& joint : mechanism.cut_joints) {
    joint_rows_.push_back(joint.clearance ? -1 : rows);
    if (!joint.clearance) rows += 5;
  }
  first_drive_row_ = rows;
  if (mechanism.drive_rows == DriveRows::kMultipliers) rows += static_cast<Eigen::Index>(mechanism.drives.size());
  Phi.setZero(rows);
  Phi_d.setZero(rows);
  bias.setZero(rows);
  Phi_q.setZero(rows, static_cast<Eigen::Index>(mechanism.coordinates.size()));
}

void Constraints::calc(const std::vector<FrameMotion>& frames, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, double t) {
  for (std::size_t k = 0; k < mechanism_.cut_joints.size(); ++k)
    if (joint_rows_[k] >= 0) calc_joint(mechanism_.cut_joints[k], frames, joint_rows_[k]);
  if (mechanism_.drive_rows != DriveRows::kMultipliers) return;
  for (std::size_t k = 0; k < mechanism_.drives.size(); ++k) {
    const Drive& drive = mechanism_.drives[k];
    const DrivenMotion wanted = calc_driven_motion(drive.law, t);
    const Eigen::Index row = row_of_drive(k);
    Phi[row] = q[drive.coordinate] - wanted.q;
    Phi_d[row] = qd[drive.coordinate] - wanted.qd;
    bias[row] = -wanted.qdd;
    Phi_q(row, drive.coordinate) = 1.0;
  }
}

void Constraints::calc_joint(const CutJoint& joint, const std::vector<FrameMotion>& frames, Eigen::Index row) {
  const FrameMotion b = calc_bearing_motion(mechanism_, joint, frames);
  const FrameMotion j = calc_journal_motion(mechanism_, joint, frames);
  Phi.segment<3>(row) = j.p - b.p;
  Phi_d.segment<3>(row) = j.v - b.v;
  bias.segment<3>(row) = j.vd - b.vd;
  const Eigen::Vector3d z = b.R.col(2);
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d x = j.R.col(i);
    const Eigen::Vector3d x_z = x.cross(z);
    Phi[row + 3 + i] = z.dot(x);
    Phi_d[row + 3 + i] = (j.w - b.w).dot(x_z);
    bias[row + 3 + i] = (j.wd - b.wd).dot(x_z) + (j.w - b.w).dot(j.w.cross(x).cross(z) + x.cross(b.w.cross(z)));
  }
  calc_joint_jacobian(joint, frames, b, j, row);
}

void Constraints::calc_joint_jacobian(const CutJoint& joint, const std::vector<FrameMotion>& frames, const FrameMotion& b,
                                      const FrameMotion& j, Eigen::Index row) {
  Phi_q.middleRows<5>(row).setZero();
  const Eigen::Vector3d x_z = j.R.col(0).cross(b.R.col(2));
  const Eigen::Vector3d y_z = j.R.col(1).cross(b.R.col(2));
  const auto add_chain = [&](FrameIndex frame, const Eigen::Vector3d& point, double sign) {
    for (FrameIndex i = frame; i != kGround; i = mechanism_.coordinates[static_cast<std::size_t>(i)].parent) {
      const auto k = static_cast<std::size_t>(i);
      const JacobianColumn column = calc_jacobian_column(mechanism_.coordinates[k], frames[k], point);
      Phi_q.col(i).segment<3>(row) += sign * column.v;
      Phi_q(row + 3, i) += sign * column.w.dot(x_z);
      Phi_q(row + 4, i) += sign * column.w.dot(y_z);
    }
  };
  add_chain(joint.journal_frame, j.p, 1.0);
  add_chain(joint.bearing_frame, b.p, -1.0);
}

}  // namespace engine
