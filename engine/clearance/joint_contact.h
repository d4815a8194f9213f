// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/clearance_joint.h"
#include "engine/clearance/continuum_law.h"
#include "engine/clearance/elements_law.h"
#include "engine/clearance/faces_law.h"
#include "engine/clearance/point_contacts_law.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// All contacts of a joint. @returns false if an element touched that has no bristle in the state
template <typename P, typename V, typename Load>
[[nodiscard]] RPSUP_INLINE bool add_contacts(const ClearanceJoint& joint, const RelativeMotion<P, V>& journal,
                                             const V* bristles, V* bristle_rates, Load& load) {
  add_faces(joint.faces(), journal, load);
  if (const RadialElements* elements = joint.elements()) {
    const RelativeMotion<P, V> journal_copy =
        journal;  // of which addresses are known: the others may stay in registers
    Load load_copy = load;
    const bool complete = add_elements(*elements, journal_copy, bristles, bristle_rates, load_copy);
    load = load_copy;
    return complete;
  }
  if (const PointContacts* points = joint.points()) {
    const RelativeMotion<P, V> journal_copy = journal;
    Load load_copy = load;
    add_point_contacts(*points, journal_copy, bristles, bristle_rates, load_copy);
    load = load_copy;
    return true;
  }
  add_continuum(*joint.continuum(), journal, bristles, bristle_rates, load);
  return true;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
