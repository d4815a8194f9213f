#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "engine/clearance/clearance_joint.h"
#include "engine/dynamics/evaluation.h"
#include "engine/kinematics/tree_model.h"
#include "engine/model/drive_law.h"

namespace engine {

/// What came of an evaluation of the equations of motion.
enum class EvaluationStatus {
  kOk,
  kBristleMissing,  ///< an element touched that has no place in the state: widen_bristles() and step again
  kLocked,          ///< the constraints' matrix is singular
  kOutOfRange,      ///< a penetration beyond what the contact's stiffness law holds for
  kNonFinite,       ///< no number, or a mass matrix that is not positive definite
};

/// Derivatives of the outputs (accelerations of the free coordinates, rates of work and loss) and of the rates of the acting bristles, by the free
/// coordinates, their rates, time and the acting bristles. Of a pair of bristles, which are those of one touch, both rates depend on both bristles
/// and on none of another pair. An owner gives the room, which is zero at first.
struct Linearisation {
  int outputs = 0;
  int pairs = 0;                 ///< pairs of bristles that act
  int stride = 0;                ///< even, with room for one pair more than there are
  int* bristles = nullptr;       ///< which ones, by their place among all: those of the first pair, then the others
  double* by_t = nullptr;        ///< outputs
  double* by_q = nullptr;        ///< outputs x free coordinates, row after row
  double* by_v = nullptr;        ///< the same
  double* by_bristle = nullptr;  ///< outputs x 2 x stride: by the first bristle of each pair, then by the second
  // Of the bristles' rates, pair by pair: first those of the first bristle of each pair, then of the second
  double* rates_by_t = nullptr;    ///< 2 x stride
  double* rates_by_q = nullptr;    ///< free coordinates x 2 x stride
  double* rates_by_v = nullptr;    ///< the same
  double* rates_by_own = nullptr;  ///< 2 x 2 x stride: of the first by the first, of the first by the second, of the second ...
};

/// Linearisation::stride for so many bristles.
[[nodiscard]] constexpr int calc_pair_stride(int bristles) { return 2 * (bristles / 4 + 1); }

/// The equations of motion, compiled for one instruction set: one call evaluates everything.
class Equations {
 public:
  virtual ~Equations() = default;
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;

  /// @param y      state as MotionSystem describes it
  /// @param drives        motion of each drive at the time of y
  /// @param drives_moved  whether it is another one than in the last call
  [[nodiscard]] virtual EvaluationStatus evaluate(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) = 0;
  /// The same, and keeps all that it finds on the way.
  [[nodiscard]] virtual EvaluationStatus evaluate_and_keep(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) = 0;

  /// What evaluate_and_keep() last found, for observers.
  virtual void read_out(Evaluation& at) const = 0;

  /// All derivatives where evaluate_and_keep() was last called, and came to an end: at the same y and motion of the drives. Exact to rounding.
  virtual void linearise(const double* y, const DrivenMotion* drives, Linearisation& result) = 0;

  /// Whether the systems of an implicit step can be solved body by body, without the derivatives by coordinates, rates and bristles.
  [[nodiscard]] virtual bool can_solve_by_bodies() const = 0;
  /// The same as linearise() for that: computes the derivatives by time, and keeps what factor_bodies() needs of the others.
  virtual void linearise_bodies(const double* y, const DrivenMotion* drives, Linearisation& result) = 0;
  /// Factors (shift 1 - J), J the Jacobian of MotionSystem's state equation at the last linearise_bodies(). False if it is singular.
  [[nodiscard]] virtual bool factor_bodies(double shift) = 0;
  /// x <- (shift 1 - J)^-1 x
  virtual void solve_bodies(double* x) = 0;

 protected:
  Equations() = default;
};

/// Names of the instruction sets that this program was compiled for and this machine has; the best one is last.
[[nodiscard]] std::vector<std::string_view> instruction_sets();

/// @param instruction_set  one of instruction_sets(); results are the same to the last bit
/// @param model, joints    must outlive the equations; `joints` are the mechanism's joints with clearance, with what they remember
[[nodiscard]] std::unique_ptr<Equations> make_equations(std::string_view instruction_set, const TreeModel& model,
                                                        const std::vector<ClearanceJoint>& joints);

}  // namespace engine
