// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/mujoco_linkage.h"

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "tests/bench/codes/acceleration_peak.h"
#include "tests/bench/codes/mujoco_model.h"
#include "tests/bench/support/cpu_time.h"

namespace bench {

namespace {

struct FreeModel {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};

std::unique_ptr<mjModel, FreeModel> compile(const std::string& mjcf) {
  const auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  if (mj_makeEmptyFileVFS(vfs.get(), "linkage.xml", static_cast<int>(mjcf.size())) != 0)
    throw std::runtime_error("MuJoCo's file system");
  std::memcpy(vfs->filedata[mj_findFileVFS(vfs.get(), "linkage.xml")], mjcf.data(), mjcf.size());
  std::array<char, 1000> error{};
  std::unique_ptr<mjModel, FreeModel> model(
      mj_loadXML("linkage.xml", vfs.get(), error.data(), static_cast<int>(error.size())));
  mj_deleteVFS(vfs.get());
  if (!model) throw std::runtime_error("MuJoCo refuses the linkage: " + std::string(error.data()));
  return model;
}

/// One linkage in MuJoCo. Its forces enter by MuJoCo's callbacks, which are global: one at a time.
class MujocoLinkage {
 public:
  MujocoLinkage(const PlainLinkage& plain, MujocoIntegrator integrator, double step)
      : plain_(plain),
        integrator_(integrator),
        model_(compile(write_mjcf(plain, integrator == MujocoIntegrator::kEuler ? "Euler" : "RK4", step))),
        data_(mj_makeData(model_.get())) {
    for (const PlainBody& body : plain.bodies)
      for (const PlainCoordinate& c : body.joint) take_coordinate(c);
    measured_ = dof_of(plain.measured);
    if (!plain.forces) return;
    rates_.resize(static_cast<std::size_t>(plain.forces->bristle_count()));
    bearing_ = model_->dof_bodyid[dof_of(plain.bearing)];
    journal_ = model_->dof_bodyid[dof_of(plain.journal)];
    active_ = this;
    mjcb_passive = [](const mjModel*, mjData*) { active_->add_forces(); };
    mjcb_act_dyn = [](const mjModel*, const mjData*, int i) {
      return active_->rates_[static_cast<std::size_t>(i)];
    };
  }
  ~MujocoLinkage() {
    mjcb_passive = nullptr;
    mjcb_act_dyn = nullptr;
    active_ = nullptr;
  }
  MujocoLinkage(const MujocoLinkage&) = delete;
  MujocoLinkage& operator=(const MujocoLinkage&) = delete;

  /// Evaluates at the start of step k; contacts that began or ended in the step before are noted in the midst
  /// of it.
  CoordinateSample evaluate(long k) {
    data_->time = static_cast<double>(k) * model_->opt.timestep;
    // exact again: their integration leaves rounding, or Euler's error
    for (const Driven& driven : driven_) {
      const PlainDriven motion = driven.law(data_->time);
      data_->qpos[driven.dof] = motion.q;
      data_->qvel[driven.dof] = motion.qd;
    }
    step_begins_ = true;
    evaluate_again();
    return {data_->time, data_->qpos[measured_], data_->qvel[measured_], data_->qacc[measured_]};
  }

  void evaluate_again() { mj_forward(model_.get(), data_.get()); }

  void advance() {
    if (integrator_ == MujocoIntegrator::kEuler)
      mj_Euler(model_.get(), data_.get());
    else
      mj_RungeKutta(model_.get(), data_.get(), 4);
  }

 private:
  struct Driven {
    int dof;
    std::function<PlainDriven(double)> law;
  };

  int dof_of(const PlainCoordinate& c) const {
    return model_->jnt_dofadr[mj_name2id(model_.get(), mjOBJ_JOINT, c.name.c_str())];
  }
  int dof_of(int body) const { return dof_of(plain_.bodies[static_cast<std::size_t>(body)].joint.back()); }

  void take_coordinate(const PlainCoordinate& c) {
    const int dof = dof_of(c);
    data_->qpos[dof] = c.start;
    data_->qvel[dof] = c.start_rate;
    if (c.drive) driven_.push_back({dof, c.drive});
  }

  BodyMotion motion_of(int body) const {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    BodyMotion motion;
    motion.R = Eigen::Map<const RowMajor>(data_->xmat + 9 * body);
    motion.p = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body);
    motion.w = Eigen::Map<const Eigen::Vector3d>(data_->cvel + 6 * body);
    motion.v = Eigen::Map<const Eigen::Vector3d>(data_->cvel + 6 * body + 3) +
               motion.w.cross(motion.p - reference_of(body));
    return motion;
  }

  /// MuJoCo's spatial vectors of a body refer to the centre of mass of its tree.
  Eigen::Vector3d reference_of(int body) const {
    return Eigen::Map<const Eigen::Vector3d>(data_->subtree_com + 3 * model_->body_rootid[body]);
  }

  /// The passive forces that MuJoCo has no words for: those of the drives and of the contacts.
  void add_forces() {
    for (const Driven& driven : driven_)
      data_->qfrc_passive[driven.dof] += kDrivenArmature * driven.law(data_->time).qdd;
    const BodyMotion bearing = motion_of(bearing_);
    const BodyMotion journal = motion_of(journal_);
    if (step_begins_) plain_.forces->end_step(data_->time, bearing, journal, data_->act);
    step_begins_ = false;
    const JournalLoad load = plain_.forces->calc(bearing, journal, data_->act, rates_.data());
    add_load(journal_, 1.0, load);
    add_load(bearing_, -1.0, load);
  }

  /// By the joint axes that MuJoCo has at hand: faster than its mj_applyFT, which makes a whole Jacobian.
  void add_load(int body, double sign, const JournalLoad& load) {
    const Eigen::Vector3d torque = load.moment + (load.p_j - reference_of(body)).cross(load.force);
    for (int i = model_->body_dofadr[body] + model_->body_dofnum[body] - 1; i >= 0;
         i = model_->dof_parentid[i]) {
      const Eigen::Map<const Eigen::Vector3d> turn(data_->cdof + 6 * i), shift(data_->cdof + 6 * i + 3);
      data_->qfrc_passive[i] += sign * (turn.dot(torque) + shift.dot(load.force));
    }
  }

  static inline MujocoLinkage* active_ = nullptr;

  const PlainLinkage& plain_;
  MujocoIntegrator integrator_;
  std::unique_ptr<mjModel, FreeModel> model_;
  std::unique_ptr<mjData, FreeModel> data_;
  std::vector<double> rates_;    // of the bristles
  std::vector<Driven> driven_;
  int measured_ = 0;               // degree of freedom
  int bearing_ = 0, journal_ = 0;  // MuJoCo's bodies
  bool step_begins_ = false;
};

}  // namespace

CodeRun run_mujoco(const PlainLinkage& plain, MujocoIntegrator integrator, double step, double duration) {
  MujocoLinkage linkage(plain, integrator, step);
  AccelerationPeak peak(plain.steady_from);
  const long steps = std::lround(duration / step);
  for (long k = 0; k <= steps; ++k) {
    const CoordinateSample measured = linkage.evaluate(k);
    peak.take(measured.t, measured.velocity, measured.acceleration);
    if (k < steps) linkage.advance();
  }
  return {peak.magnitude(), steps * (integrator == MujocoIntegrator::kEuler ? 1 : 4) + 1};
}

double time_mujoco_evaluation(const PlainLinkage& plain) {
  MujocoLinkage linkage(plain, MujocoIntegrator::kRk4, 1e-5);
  (void)linkage.evaluate(0);
  return time_short([&linkage] { linkage.evaluate_again(); });
}

}  // namespace bench
