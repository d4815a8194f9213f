// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "validation/formulation/parts.h"

namespace validation {

std::vector<CouplerCase> coupler_cases() {
  RpsupParameters p;
  p.crank_length = 0.18;
  p.links[0] = beam_inertia(0.471, 0.18, 6.964e-5);
  p.guide_offset_y = 0.03;
  p.guide_offset_z = 0.17;
  std::vector<CouplerCase> cases{{"rigid coupler", p}};
  RpsupParameters flexible = p;
  flexible.coupler = Coupler::kFlexible;
  for (const int n_rfe : {2, 4, 10}) {
    flexible.rigid_elements = n_rfe;
    cases.push_back({"flexible coupler, n_rfe = " + std::to_string(n_rfe), flexible});
  }
  flexible.rigid_elements = 4;
  for (RpsupParameters turned : {p, flexible}) {
    turned.guide_angle = 0.3;
    turned.gravity_direction = Direction::kMinusY;
    const std::string guide = ", guide turned by 0.3 rad, gravity along -y";
    const std::string coupler =
        turned.coupler == Coupler::kRigid ? "rigid coupler" : "flexible coupler, n_rfe = 4";
    cases.push_back({coupler + guide, turned});
    turned.yoke_axis = YokeAxis::kAcross;
    cases.push_back({coupler + ", yoke across the guide" + guide, turned});
  }
  return cases;
}

ChainState draw_state(const Mechanism& mechanism, Random& random) {
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  ChainState state{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Coordinate& c = mechanism.coordinates[static_cast<std::size_t>(i)];
    const bool slides = c.motion == Motion::kTranslation;
    const bool second_of_three = c.axis == Axis::kY && i + 1 < n;
    state.q[i] = random.symmetric(slides            ? 0.3
                                  : second_of_three ? std::numbers::pi * 70.0 / 180.0
                                                    : std::numbers::pi);
    state.qd[i] = random.symmetric(slides ? 2.0 : 10.0);
  }
  return state;
}

Mechanism open_chains(Mechanism mechanism) {
  mechanism.cut_joints.clear();
  mechanism.drives.clear();
  return mechanism;
}

double relative_difference(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  // a maximum of coefficients may lose it
  if (!found.allFinite() || !expected.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace validation
