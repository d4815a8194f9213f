// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/clearance/clearance_joint.h"
#include "engine/clearance/contact_derivative.h"
#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/kernel/forward/loss_powers.h"
#include "engine/dynamics/kernel/newton/condensed_contact.h"
#include "engine/dynamics/kernel/tangent/contact_tangent.h"
#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/dense_matrix.h"
#include "engine/math/lanes.h"
#include "engine/math/number_rows.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// By how much one number follows each of nine others; the first eight are used side by side.
template <typename Scalar>
class InputRow;
template <>
class InputRow<double> {
 public:
  [[nodiscard]] RPSUP_INLINE double operator[](int i) const { return numbers_[i]; }
  [[nodiscard]] RPSUP_INLINE Lanes most() const { return Lanes::load(numbers_); }
  [[nodiscard]] RPSUP_INLINE double last() const { return numbers_[Lanes::kCount]; }
  RPSUP_INLINE void set(const Lanes& most, double last) {
    most.store(numbers_);
    numbers_[Lanes::kCount] = last;
  }

 private:
  double numbers_[Lanes::kCount + 1]{};
};
template <>
class InputRow<Complex<double>> {
 public:
  [[nodiscard]] RPSUP_INLINE Complex<double> operator[](int i) const { return {real_[i], imag_[i]}; }
  [[nodiscard]] RPSUP_INLINE Complex<Lanes> most() const { return {real_.most(), imag_.most()}; }
  [[nodiscard]] RPSUP_INLINE Complex<double> last() const { return {real_.last(), imag_.last()}; }
  RPSUP_INLINE void set(const Complex<Lanes>& most, const Complex<double>& last) {
    real_.set(most.real, last.real);
    imag_.set(most.imag, last.imag);
  }

 private:
  InputRow<double> real_, imag_;
};

/// A solution of the equations of motion, and what of it their variations need. All but the contacts' derivatives and bristles is copied.
struct BodiesSolution {
  const Frame<double, double>* frames;
  const JointAxes* axes;
  const HeldJoint* held;
  const HeldCoordinate* held_coordinates;
  const CutJointMotion<double, double>* cuts;
  const std::unique_ptr<ContactDerivative>* contacts;
  const ActingBristles* acting;
  const double* qd;
};

/// Whether a mechanism's systems can be solved body by body: if it has no constraints, and no springs between points.
[[nodiscard]] inline bool fits_bodies(const TreeModel& model) { return model.rows == 0 && model.springs.empty(); }

/// The system (shift 1 - J) x = known of an implicit step solved body by body, J the Jacobian of MotionSystem's state equation: in a time that
/// grows with the number of bodies and of bristles. J itself is never written down.
///
/// The unknowns are the variations u of the free coordinates' rates. With them each coordinate and its acceleration are known,
///
///     dq = (u + known_q) / shift,  dqd = u,  dqdd = shift u - known_v
///
/// so that the variation of a body's frame is a linear function of its parent's and of its own joint's u. The force that a body and all that it
/// carries need follows the frame's variation (dw, dwd, dvd), nine numbers as seen by who turns with it: see VariedFrame. Of that a joint's u are
/// eliminated on the way to the root, and found on the way back, as accelerations are by ArticulatedBodies.
///
/// Contacts join bodies that are no parent and child. How all answers the twelve numbers of a journal's motion, taken as given, leaves a matrix
/// of twelve for each joint that touches (Woodbury's identity). It costs digits where a contact is stiffer than all that moves without it.
///
/// @tparam Scalar  double or Complex<double>, as the shift is
template <typename Scalar>
class ShiftedBodies {
 public:
  /// @param model, joints  must outlive this
  ShiftedBodies(const TreeModel& model, const std::vector<ClearanceJoint>& joints);

  void take_up(const BodiesSolution& solution);

  /// False if (shift 1 - J) is singular.
  [[nodiscard]] bool factor(const Scalar& shift);
  /// x <- (shift 1 - J)^-1 x, of a state as MotionSystem has it.
  void solve_in_place(NumbersAt<Scalar> x);

 private:
  static constexpr int kForces = 6;             ///< force and moment
  static constexpr std::size_t kJournal = ShiftedContact<Scalar>::kJournal;

  template <int count>
  using Block = typename NumbersOf<Scalar>::template Block<count>;
  using Wide = Block<Lanes::kCount>;            ///< the first eight of the nine numbers side by side, or eight of the journals'
  using Rest = Block<1 + 3>;                    ///< the last of the nine numbers and a joint's three u, side by side

  /// A body and the joint that carries it.
  struct Body {
    // Of the solution
    Mat3<double> R;
    Vec3<double> p;
    JointAxes axes;
    HeldJoint held;
    HeldCoordinate coordinates[3];
    double rate_of_loss[3];            ///< of dampers, by the coordinate's rate
    // Of the factors
    InputRow<Scalar> answer[kForces];  ///< of all that it carries: the force needed, by the frame's variation
    Scalar by_own[kForces][3];         ///< the force passed on to the parent, by u
    Scalar inverse[3][3];              ///< of what the joint lacks of balance, by u
    InputRow<Scalar> by_parent[3];     ///< u, or of a driven joint its force, by the parent's variation
  };
  /// Room for solutions in one or several directions.
  template <typename T>
  struct Room {
    explicit Room(const TreeModel& model);
    Buffer<SpatialForce<T>> forces;    ///< in: needed more by each body; then all that is needed behind its joint, with what is known of u
    Buffer<T> own;                     ///< u before the parent moves, or of a driven joint its force; one a coordinate
    Buffer<VariedFrame<T>> frames;
    Buffer<T> u;                       ///< of the free coordinates
    Buffer<T> drive_force;
  };
  /// What a joint passes on.
  template <typename T>
  struct Passed {
    SpatialForce<T> to_parent;         ///< about the parent's origin
    T lacks[3];                        ///< of balance, along each axis
  };
  /// A joint with clearance.
  struct Contact {
    Contact(const TreeCutJoint& on, std::size_t bristles) : joint(on), shifted(bristles) {}
    const TreeCutJoint& joint;
    CutJointMotion<double, double> cut;
    const ContactDerivative* derivative = nullptr;
    ActingBristles acting;
    ShiftedContact<Scalar> shifted;
  };

  [[nodiscard]] bool eliminate(std::size_t i);
  void carry(std::size_t i, int count, Passed<Rest> rest);
  template <typename T>
  [[nodiscard]] Passed<T> respond(std::size_t i, VariedFrame<T> f, const CoordinateVariation<T>* own) const;
  template <typename T>
  [[nodiscard]] Passed<T> pass_on(std::size_t i, const CoordinateVariation<T>* own, const Vec3<T>& own_turn, SpatialForce<T> force) const;

  [[nodiscard]] bool factor_contacts();
  void answer_journals(std::size_t group);
  template <typename T>
  void add_need(const Contact& contact, const Vec3<T>& turn, const Vec3<T>& offset, const LoadVariation<T>& load, Room<T>& room) const;
  template <typename T>
  [[nodiscard]] JournalVariation<T> calc_journal(const Contact& contact, const Room<T>& room) const;
  template <typename T>
  [[nodiscard]] VariedFrame<T> see_at(int joint, const Vec3<double>& p, const Room<T>& room) const;
  [[nodiscard]] Vec3<double> arm_of(int joint, const Vec3<double>& p) const;

  template <typename T>
  [[nodiscard]] CoordinateVariation<T> vary_known(const TreeJoint& joint, int k, const NumbersAt<Scalar>* known) const;
  template <typename T>
  void pass_inwards(const NumbersAt<Scalar>* known, Room<T>& room) const;
  template <typename T>
  void pass_outwards(const NumbersAt<Scalar>* known, Room<T>& room) const;
  void solve_journals(NumbersAt<Scalar> z);
  void add_losses(const LoadVariation<Scalar>& load);
  void write_state(NumbersAt<Scalar> x) const;

  const TreeModel& model_;
  int free_, bristles_;
  Scalar shift_{1.0}, inverse_shift_{1.0};
  Buffer<Body> bodies_;
  Buffer<double> drive_rates_;
  std::vector<std::unique_ptr<Contact>> contacts_;
  Buffer<Contact*> touching_;
  std::size_t touching_count_ = 0, groups_ = 0;   ///< groups: of the touching journals' numbers, several side by side
  DenseMatrix<Scalar> journal_matrix_;            ///< of those numbers
  Buffer<Scalar> journals_;                       ///< the numbers
  Buffer<Wide> journal_groups_;                   ///< the same in whole groups
  Buffer<Wide> u_by_journals_;                    ///< free coordinates x groups
  Buffer<Wide> drive_force_by_journals_;          ///< drives x groups
  LossPowers<Scalar> losses_;
  Room<Scalar> room_;
  Room<Wide> wide_room_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
