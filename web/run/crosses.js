// SPDX-License-Identifier: Apache-2.0
// Universal joints with clearance as the engine takes them.

/// A described linkage whose universal joints with clearance are two revolute joints each, NAME_first and
/// NAME_second, with a body NAME_cross between them. Other linkages stay as they are.
/** @param {Api.DescribedLinkage} linkage  @returns {Api.DescribedLinkage} */
export function withCrosses(linkage) {
  const crossed = Object.entries(linkage.joints).filter(([, joint]) => hasCross(joint));
  if (crossed.length === 0) return linkage;
  const bodies = { ...linkage.bodies };
  for (const [name, { cross }] of crossed) bodies[`${name}_cross`] = cross ?? { mass_kg: 0 };
  /** @type {[string, Api.DescribedJoint][]} */
  const joints = [];
  for (const [name, joint] of Object.entries(linkage.joints)) {
    if (hasCross(joint)) joints.push(...halvesOf(name, joint));
    else joints.push([name, joint]);
  }
  return { ...linkage, bodies, joints: Object.fromEntries(joints) };
}

/** @type {(joint: Api.DescribedJoint) => boolean} */
const hasCross = ({ kind, clearance }) => kind === "universal" && clearance !== undefined;

/// The first joint carries the cross; the second one closes a loop if the universal joint does.
/**
 * @param {string} name
 * @param {Api.DescribedJoint} joint
 * @returns {[string, Api.DescribedJoint][]}
 */
function halvesOf(name, { from, to, at_m, turned_deg, axis, second_axis: second = "y", clearance, ...closing }) {
  const cross = `${name}_cross`;
  const { closes_loop, to_at_m, to_turned_deg } = closing;
  return [[`${name}_first`, { kind: "revolute", from, to: cross, at_m, turned_deg, axis, clearance }],
    [`${name}_second`, { kind: "revolute", from: cross, to, axis: second, closes_loop, to_at_m, to_turned_deg,
      clearance }]];
}
