// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/joint_contact.h"

#include <stdexcept>

#include "engine/clearance/clearance_joint.h"

namespace bench {

namespace {

class JointContact : public JointForces {
 public:
  explicit JointContact(const engine::CutJoint& joint) : places_(joint), joint_(joint.clearance.value()) {}

  [[nodiscard]] int bristle_count() const override { return joint_.bristle_count(); }

  [[nodiscard]] JournalLoad calc(const BodyMotion& bearing, const BodyMotion& journal, const double* bristles,
                                 double* bristle_rates) const override {
    const Seen seen = see(bearing, journal);
    engine::ContactLoad load;
    // only elements may ask for more bristles
    (void)joint_.calc(seen.journal, bristles, bristle_rates, load);
    return {seen.p_j, seen.R_Wb * load.force, seen.R_Wb * load.moment};
  }

  bool end_step(double t, const BodyMotion& bearing, const BodyMotion& journal, double* bristles) override {
    const engine::JournalMotion now = see(bearing, journal).journal;
    const bool changed =
        last_t_ >= 0.0 && t > last_t_ && joint_.advance(last_, now, t - last_t_, bristles).any;
    last_ = now;
    last_t_ = t;
    return changed;
  }

 private:
  struct Seen {
    engine::JournalMotion journal;
    Eigen::Matrix3d R_Wb;
    Eigen::Vector3d p_j;
  };

  [[nodiscard]] Seen see(const BodyMotion& bearing, const BodyMotion& journal) const {
    const Eigen::Vector3d r_b = bearing.R * places_.bearing.p;
    const Eigen::Vector3d r_j = journal.R * places_.journal.p;
    Seen seen;
    seen.R_Wb = bearing.R * places_.bearing.R;
    seen.p_j = journal.p + r_j;
    const Eigen::Matrix3d R_bW = seen.R_Wb.transpose();
    const Eigen::Vector3d offset = seen.p_j - (bearing.p + r_b);
    seen.journal.R_bj = R_bW * journal.R * places_.journal.R;
    seen.journal.p_bj = R_bW * offset;
    seen.journal.v = R_bW * (journal.v + journal.w.cross(r_j) - bearing.v - bearing.w.cross(r_b + offset));
    seen.journal.w = R_bW * (journal.w - bearing.w);
    return seen;
  }

  engine::CutJoint places_;
  engine::ClearanceJoint joint_;
  engine::JournalMotion last_;
  double last_t_ = -1.0;  ///< < 0: no step has begun
};

}  // namespace

std::unique_ptr<JointForces> make_joint_forces(const engine::CutJoint& joint) {
  if (joint.clearance.value().form != engine::RadialForm::kContinuum)
    throw std::invalid_argument("other codes have no bristles that move");
  return std::make_unique<JointContact>(joint);
}

}  // namespace bench
