// SPDX-License-Identifier: Apache-2.0
// Places of the RPSUP linkage in the global frame {0}, from its parameters.
const stepsOfTurn = 24;

/// The guide: a point of it, and its direction. The slider's axes are turned with it, about y.
/** @param {Api.Parameters} parameters */
export function guideOf({ guide_offset_y_m: y, guide_offset_z_m: z, guide_angle_deg: degrees = 0 }) {
  const angle = (degrees * Math.PI) / 180;
  return { point: [0, y, z], angle, direction: [Math.cos(angle), 0, Math.sin(angle)] };
}

/// Distances of the S joint from the crank's axis, while the rod rests and at the end of its stroke; with an actuator
/// where it starts [m].
/** @param {Api.Parameters} parameters */
export function rodEnds({ rod_length_m: length, rod_start_m: start = length, rod_stroke_mm: stroke, rod_drive: drive }) {
  /** @type {any} */
  const given = drive;
  if (given) return given.law ? endsOfDrive(given).map((way) => length + way) : [start, start];
  return [start, start + stroke / 1000];
}

/// Least and largest position that a law gives; its start where that is not said [m].
/** @param {any} drive */
function endsOfDrive({ from_m: from = 0, stroke_m: stroke = 0, rise_m: rise = 0, mean_m: mean = from, amplitude_m: amplitude = 0,
  values_m: values = [mean - amplitude, mean + amplitude + stroke + rise] }) {
  return [Math.min(...values), Math.max(...values)];
}

/// Places to which the S joint and the slider come in a turn of the crank, and the crank's centre and end.
/// The slider of an S joint that the coupler cannot join to the guide is taken to be beside the joint.
/** @param {Api.Parameters} parameters  @returns {number[][]} */
export function placesOf(parameters) {
  const { coupler_length_m: length, crank_length_m: crank, cross_length_mm: cross = 0, yoke_axis: yoke = "across" } =
    parameters;
  const { point, direction: [c, , s] } = guideOf(parameters);
  const arm = cross / 1000;
  /** @type {(ball: number[]) => number[]} */
  const slider = ([x, y, z]) => {
    const [along, aside, above] = [c * x + s * (z - point[2]), y - point[1], c * (z - point[2]) - s * x];
    const apart = yoke === "guide" ? above ** 2 - arm ** 2 : Math.max(0, above ** 2 - arm ** 2);
    const place = along + Math.sqrt(Math.max(0, length ** 2 - aside ** 2 - apart));
    return [c * place, point[1], point[2] + s * place];
  };
  const turn = Array.from({ length: stepsOfTurn }, (_, k) => (2 * Math.PI * k) / stepsOfTurn);
  const circle = (radius) => turn.map((angle) => [radius * Math.cos(angle), radius * Math.sin(angle), 0]);
  const balls = rodEnds(parameters).flatMap(circle);
  return [[0, 0, 0], ...circle(crank), ...balls, ...balls.map(slider)];
}
