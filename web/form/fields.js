// SPDX-License-Identifier: Apache-2.0
// The parameters of the service's JSON Schema as fields of a form.

/// Parameters without a field, which are written as JSON: drives, the worn bore, and what is kept of a job.
export const writtenAsJson = ["crank_drive", "rod_drive", "wear_depth_um", "keep"];

const ofRpsup =
  /^((coupler|crank|rod|guide|cross)(_|$)|yoke_axis$|rigid_elements$|gravity_direction$|links\.)/;

/// Whether a parameter is of the RPSUP linkage alone. Beams of described linkages take the moduli of the job.
/** @type {(path: string) => boolean} */
export const isOfRpsup = (path) => ofRpsup.test(path);

const ofContact = new RegExp("^((axial|radial|bearing|bristle|contact|friction|stribeck)(_|$)"
  + "|break_away_ratio$|clearance_mm$|minimum_impact_velocity_m_s$|normal_law$|restitution$|stiffness_law$)");

/// Whether a parameter is of the contact in joints with clearance.
/** @type {(path: string) => boolean} */
export const isContact = (path) => ofContact.test(path);

/// One field for each parameter, those of links by their path: {path, kind, unit, default, help, source, schema}.
export function fieldsOf(schema, prefix = "") {
  return Object.entries(schema.properties).filter(([key]) => key !== "linkage" && !writtenAsJson.includes(key))
    .flatMap(([key, property]) =>
    (property.type === "object" ? fieldsOf(property, `${prefix}${key}.`) : [fieldOf(prefix + key, property)]));
}

function fieldOf(path, property) {
  const kind = property.enum ? "words" : property.type === "array" ? "numbers" : property.type;
  return { path, kind, unit: property["x-unit"] ?? "", default: property.default, help: property.description ?? "",
    source: property["x-default-source"] ?? "", schema: property };
}

/// Allowed values in words: "≥ 0, < 1000 mm".
export function allowed(field) {
  const { schema } = field;
  if (field.kind === "words") return schema.enum.join(", ");
  const bounds = boundsOf(field);
  const text = [["≥", bounds.minimum], [">", bounds.exclusiveMinimum], ["≤", bounds.maximum],
    ["<", bounds.exclusiveMaximum]]
    .filter(([, bound]) => bound !== undefined).map(([sign, bound]) => `${sign} ${bound}`).join(", ");
  const count = field.kind === "numbers" ? `${schema.minItems} numbers ` : "";
  return `${count}${text}${field.unit ? ` ${field.unit}` : ""}`;
}

function boundsOf(field) {
  return field.kind === "numbers" ? field.schema.items : field.schema;
}

/// Fault of a value of this field; empty if it is allowed.
export function faultOf(field, value) {
  if (!Number.isFinite(value)) return `must be a number ${allowed(field)}`;
  const { minimum, exclusiveMinimum, maximum, exclusiveMaximum } = boundsOf(field);
  const whole = field.kind !== "integer" || Number.isInteger(value);
  const inside = !(value < minimum) && !(value <= exclusiveMinimum) && !(value > maximum)
    && !(value >= exclusiveMaximum);
  return whole && inside ? ""
    : `${value} is not allowed: must be ${field.kind === "integer" ? "a whole number " : ""}${allowed(field)}`;
}

/// Whether a path names a number inside the description of a linkage or of a drive.
/** @param {string} [path] */
export const isInside = (path) => /^(linkage|crank_drive|rod_drive)\./.test(path ?? "");

/// The field that a pointer of the service's answer means: "/sweep/clearance_mm/1" is clearance_mm's.
export function pathOfPointer(pointer, fields) {
  const parts = pointer.split("/").slice(1).map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
  if (parts[0] === "cases" || parts[0] === "design") return parts[0];
  if (parts[0] !== "sweep" && parts[0] !== "parameters") return "";
  if (parts[0] === "parameters" && parts[1] === "linkage") return "linkage";
  if (parts[0] === "parameters" && writtenAsJson.includes(parts[1])) return "described";
  if (isInside(parts[1])) return "inside";
  const path = parts.slice(1).join(".");
  return fields.map((field) => field.path).find((known) => path === known || path.startsWith(`${known}.`)) ?? "";
}
