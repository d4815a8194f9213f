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
#include "engine/dynamics/kernel/newton/tree_recursion.h"
#include "engine/dynamics/kernel/tangent/operating_point.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/dense_matrix.h"
#include "engine/math/number_rows.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The contacts as a low-rank update of TreeRecursion, Eq. (K33): they couple bodies that are not parent and
/// child.
///
/// With xi the tangents of the journals' motions in joints in contact, twelve numbers each, and T_0 the
/// Newton matrix of the open chains,
///
///     T_0 x = b + Gamma xi,   xi = G x
///     =>   (1 - G T_0^-1 Gamma) xi = G T_0^-1 b,   x = T_0^-1 b + T_0^-1 Gamma xi
///
/// where Gamma xi is the right-hand side by the loads (K20) on the bodies with the condensed contact (K32), G
/// is (K19), and 1 - G T_0^-1 Gamma is the capacitance matrix of Woodbury's identity. It loses digits where a
/// contact is stiffer than all that moves without it. Source: G. H. Golub, C. F. Van Loan, Matrix
/// Computations, section 2.1 (Sherman-Morrison-Woodbury formula).
/// @tparam Scalar  double or Complex<double>
template <typename Scalar>
class ContactUpdate {
  using Tree = TreeRecursion<Scalar>;
  using Pack8 = typename Tree::Pack8;
  using Workspace = typename Tree::template Workspace<Scalar>;
  using PackWorkspace = typename Tree::template Workspace<Pack8>;

 public:
  /// @param model, joints  must outlive this
  ContactUpdate(const TreeModel& model, const std::vector<ClearanceJoint>& joints);

  /// Copies the operating point, but for the contacts' derivatives and acting bristles.
  void set_operating_point(const OperatingPointView& point);

  /// Condenses the bristles, and assembles and factors the capacitance matrix. False if one of them is
  /// singular. @param tree  factored
  [[nodiscard]] bool factor(const Tree& tree, const Scalar& shift);

  /// Adds the loads by the right-hand side z of the bristles, with xi = 0, to the bias forces and losses.
  void add_bristle_loads(const Tree& tree, NumbersAt<Scalar> z, Workspace& work, LossPowers<Scalar>& losses);

  /// Solves for xi, and adds its part to the rates, the drive forces and the losses. Sets the acting bristles
  /// in z.
  void apply_woodbury(const Tree& tree, NumbersAt<Scalar> z, Workspace& work, LossPowers<Scalar>& losses);

 private:
  static constexpr std::size_t kJournal = CondensedContact<Scalar>::kJournal;

  /// A joint with clearance.
  struct Contact {
    Contact(const TreeCutJoint& on, std::size_t bristles) : joint(on), condensed(bristles) {}
    const TreeCutJoint& joint;
    CutJointMotion<double, double> cut;
    const ContactDerivative* derivative = nullptr;
    ActingBristles acting;
    CondensedContact<Scalar> condensed;
  };

  void assemble_capacitance(const Tree& tree, std::size_t pack);
  template <typename T>
  void add_contact_force(const Tree& tree, const Contact& contact, const Vec3<T>& rotation,
                         const Vec3<T>& offset, const LoadTangent<T>& load,
                         typename Tree::template Workspace<T>& work) const;
  template <typename T>
  [[nodiscard]] JournalTangent_b<T> journal_tangent(const Tree& tree, const Contact& contact,
                                                    const typename Tree::template Workspace<T>& work) const;

  std::vector<std::unique_ptr<Contact>> contacts_;
  Buffer<Contact*> touching_;               ///< joints in contact, or with a bent bristle
  std::size_t touching_count_ = 0;
  std::size_t packs_ = 0;                   ///< of the numbers of xi
  DenseMatrix<Scalar> capacitance_matrix_;  ///< factored
  Buffer<Scalar> xi_;
  Buffer<Pack8> xi_packs_;                  ///< xi, packed
  Buffer<Pack8> qd_by_xi_;                  ///< free coordinates x packs
  Buffer<Pack8> drive_force_by_xi_;          ///< drives x packs
  PackWorkspace pack_work_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
