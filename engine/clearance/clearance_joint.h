// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

#include "engine/clearance/axial_faces.h"
#include "engine/clearance/point_contacts.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/clearance/radial_elements.h"

namespace engine {

/// All contacts of one joint with clearance, with what they remember between steps.
class ClearanceJoint {
 public:
  explicit ClearanceJoint(const ClearanceParameters& joint);

  /// Number of rings, or of contacts that a ball or a block may have.
  [[nodiscard]] int ring_count() const;
  [[nodiscard]] int bristle_count() const;

  // For the laws, which the right-hand side takes with its own kind of numbers.
  [[nodiscard]] const AxialFaces& faces() const { return faces_; }
  /// One of the three; the others are null.
  [[nodiscard]] const RadialContinuum* continuum() const { return std::get_if<RadialContinuum>(&radial_); }
  [[nodiscard]] const RadialElements* elements() const { return std::get_if<RadialElements>(&radial_); }
  [[nodiscard]] const PointContacts* points() const { return std::get_if<PointContacts>(&radial_); }

  /// Computes the load on the journal and the bristles' rates. @returns false if an element
  /// touches without a bristle in the state: widen()
  [[nodiscard]] bool calc(const JournalMotion& journal, const double* bristles, double* bristle_rates,
                          ContactLoad& load) const;

  /// Appends the penetration of each ring, negative where there is a gap.
  void add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const;

  /// Before a step: bristles follow the contact around the journal. @returns true if any changed its index
  bool follow(const JournalMotion& journal, double dt, double* bristles);

  /// After a step: which contacts began or ended in it.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles);

  [[nodiscard]] Eigen::VectorXd widen(const double* bristles);

 private:
  std::variant<RadialContinuum, RadialElements, PointContacts> radial_;
  AxialFaces faces_;
};

}  // namespace engine
