// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/simbody_linkage.h"

#include <algorithm>
#include <vector>

#include "tests/bench/codes/acceleration_peak.h"
#include "tests/bench/codes/simbody_model.h"
#include "tests/bench/support/cpu_time.h"

namespace bench {

namespace {

Eigen::Vector3d to_eigen(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }
SimTK::Vec3 to_simbody(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

BodyMotion motion_of(const SimTK::MobilizedBody& body, const SimTK::State& state) {
  const SimTK::Transform& X = body.getBodyTransform(state);
  const SimTK::SpatialVec& V = body.getBodyVelocity(state);
  BodyMotion motion;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) motion.R(i, k) = X.R()[i][k];
  motion.p = to_eigen(X.p());
  motion.w = to_eigen(V[0]);
  motion.v = to_eigen(V[1]);
  return motion;
}

/// The joint with clearance as a force; its bristles are auxiliary state variables.
class ContactForce : public SimTK::Force::Custom::Implementation {
 public:
  ContactForce(SimTK::GeneralForceSubsystem& forces, JointForces& joint, const SimTK::MobilizedBody& bearing,
               const SimTK::MobilizedBody& journal)
      : forces_(forces),
        joint_(joint),
        bearing_(bearing),
        journal_(journal),
        rates_(joint.bristle_count(), 0.0) {}

  void realizeTopology(SimTK::State& state) const override { first_ = forces_.allocateZ(state, rates_); }

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector&) const override {
    const BodyMotion b = motion_of(bearing_, state);
    const BodyMotion j = motion_of(journal_, state);
    const JournalLoad load = joint_.calc(b, j, &forces_.getZ(state)[first_], &rates_[0]);
    add(load, 1.0, j, journal_, body_forces);
    add(load, -1.0, b, bearing_, body_forces);
  }
  void realizeAcceleration(const SimTK::State& state) const override {
    for (int i = 0; i < rates_.size(); ++i) forces_.updZDot(state)[first_ + i] = rates_[i];
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

  /// Takes note of contacts that began or ended up to this state. @returns true if any did: the forces are
  /// others then
  bool end_step(const SimTK::State& state, SimTK::Real* bristles) {
    return joint_.end_step(state.getTime(), motion_of(bearing_, state), motion_of(journal_, state), bristles);
  }
  [[nodiscard]] SimTK::Real* bristles(SimTK::State& state) const { return &forces_.updZ(state)[first_]; }
  [[nodiscard]] const SimTK::Real* bristles(const SimTK::State& state) const {
    return &forces_.getZ(state)[first_];
  }

 private:
  static void add(const JournalLoad& load, double sign, const BodyMotion& motion,
                  const SimTK::MobilizedBody& body, SimTK::Vector_<SimTK::SpatialVec>& body_forces) {
    const Eigen::Vector3d torque = load.moment + (load.p_j - motion.p).cross(load.force);
    body_forces[body.getMobilizedBodyIndex()] +=
        SimTK::SpatialVec(to_simbody(sign * torque), to_simbody(sign * load.force));
  }

  SimTK::GeneralForceSubsystem& forces_;
  JointForces& joint_;
  SimTK::MobilizedBody bearing_, journal_;
  mutable SimTK::ZIndex first_;
  mutable SimTK::Vector rates_;
};

/// One linkage in Simbody.
class SimbodyLinkage {
 public:
  explicit SimbodyLinkage(const PlainLinkage& plain)
      : model_(plain),
        measured_(model_.body(plain.measured)),
        which_(static_cast<int>(plain.bodies[static_cast<std::size_t>(plain.measured)].joint.size()) - 1) {
    if (!plain.forces) return;
    contact_ = new ContactForce(model_.forces, *plain.forces, model_.body(plain.bearing),
                                model_.body(plain.journal));
    SimTK::Force::Custom(model_.forces, contact_);  // owns it
    bristles_.resize(static_cast<std::size_t>(plain.forces->bristle_count()));
  }

  [[nodiscard]] SimTK::State start() {
    SimTK::State state = model_.system.realizeTopology();
    model_.place(state);
    return state;
  }
  [[nodiscard]] SimTK::MultibodySystem& system() { return model_.system; }
  [[nodiscard]] CoordinateSample sample(const SimTK::State& state) const {
    model_.system.realize(state, SimTK::Stage::Acceleration);
    return {state.getTime(), measured_.getOneQ(state, which_), measured_.getOneU(state, which_),
            measured_.getOneUDot(state, which_)};
  }
  /// Where contacts changed in the step, the integrator evaluates its end again.
  void end_step(SimTK::Integrator& integrator) {
    if (!contact_) return;
    const SimTK::State& state = integrator.getState();
    std::copy_n(contact_->bristles(state), bristles_.size(), bristles_.begin());
    if (!contact_->end_step(state, bristles_.data())) return;
    std::copy(bristles_.begin(), bristles_.end(), contact_->bristles(integrator.updAdvancedState()));
    integrator.reinitialize(SimTK::Stage::Dynamics, false);
  }

 private:
  SimbodyModel model_;
  ContactForce* contact_ = nullptr;
  SimTK::MobilizedBody measured_;
  int which_;  // of its coordinates
  std::vector<double> bristles_;
};

}  // namespace

CodeRun run_simbody(const PlainLinkage& plain, double accuracy, double duration) {
  SimbodyLinkage linkage(plain);
  SimTK::RungeKuttaMersonIntegrator integrator(linkage.system());
  integrator.setAccuracy(accuracy);
  integrator.setReturnEveryInternalStep(true);
  integrator.initialize(linkage.start());
  AccelerationPeak peak(plain.steady_from);
  double t = -1.0;
  while (t < duration) {
    integrator.stepTo(duration);
    if (integrator.getTime() <= t) continue;  // it reports the start of an interval too
    const CoordinateSample measured = linkage.sample(integrator.getState());
    t = measured.t;
    peak.take(t, measured.velocity, measured.acceleration);
    linkage.end_step(integrator);
  }
  constexpr long kStages = 5;
  return {peak.magnitude(), kStages * integrator.getNumStepsAttempted()};
}

double time_simbody_evaluation(const PlainLinkage& plain) {
  SimbodyLinkage linkage(plain);
  SimTK::State state = linkage.start();
  linkage.system().realize(state, SimTK::Stage::Instance);
  return time_short([&] {
    state.setTime(0.0);  // forgets all that was computed
    linkage.system().realize(state, SimTK::Stage::Time);
    linkage.system().prescribeQ(state);
    linkage.system().realize(state, SimTK::Stage::Position);
    linkage.system().prescribeU(state);
    linkage.system().realize(state, SimTK::Stage::Acceleration);
  });
}

}  // namespace bench
