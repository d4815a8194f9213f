// SPDX-License-Identifier: Apache-2.0
// Values that a JSON Schema allows, and values that it may not allow.

import fc from "fast-check";

const largestList = 3;
const keptKeys = 4;  // of an object with many: products of axes stay small

function numberOf(schema) {
  const constraint = { noNaN: true, noDefaultInfinity: true };
  if (schema.minimum !== undefined) constraint.min = schema.minimum;
  if (schema.maximum !== undefined) constraint.max = schema.maximum;
  if (schema.exclusiveMinimum !== undefined) Object.assign(constraint, { min: schema.exclusiveMinimum, minExcluded: true });
  if (schema.exclusiveMaximum !== undefined) Object.assign(constraint, { max: schema.exclusiveMaximum, maxExcluded: true });
  const any = fc.double(constraint);
  // Near the default a linkage can be assembled; a number picked from the whole range seldom makes one.
  return typeof schema.default === "number" && schema.default !== 0
    ? fc.oneof({ weight: 3, arbitrary: fc.constantFrom(schema.default, schema.default * 0.9).filter((x) => inside(schema, x)) }, any)
    : any;
}

function integerOf({ minimum = 0, maximum = Number.MAX_SAFE_INTEGER, multipleOf: step = 1 }) {
  return fc.integer({ min: Math.ceil(minimum / step), max: Math.floor(maximum / step) }).map((times) => times * step);
}

function inside(schema, x) {
  return !(x < schema.minimum || x > schema.maximum || x <= schema.exclusiveMinimum || x >= schema.exclusiveMaximum);
}

function objectOf(schema, resolve) {
  const keys = Object.keys(schema.properties ?? {});
  const required = schema.required ?? [];
  const optional = keys.filter((key) => !required.includes(key));
  const least = Math.max(0, (schema.minProperties ?? 0) - required.length);
  return fc.subarray(optional, { minLength: Math.min(least, optional.length), maxLength: Math.min(schema.maxProperties ?? keptKeys, keptKeys, optional.length) })
    .chain((chosen) => fc.record(Object.fromEntries([...required, ...chosen].map((key) => [key, fromSchema(schema.properties[key], resolve)]))));
}

/**
 * Values that a schema allows.
 * @param resolve  turns {$ref} into the schema that it stands for
 */
export function fromSchema(given, resolve) {
  const schema = resolve(given);
  if ("const" in schema) return fc.constant(schema.const);
  if (schema.enum) return fc.constantFrom(...schema.enum);
  const choices = schema.oneOf ?? schema.anyOf;
  if (choices && schema.type === "object")  // an object that has the keys of one choice, too
    return fc.oneof(...choices.map(({ required }) => objectOf({ ...schema, required: [...schema.required, ...required] }, resolve)));
  if (choices) return fc.oneof(...choices.map((choice) => fromSchema(choice, resolve)));
  if (schema.allOf) return fromSchema({ ...resolve(schema.allOf[0]), minProperties: schema.minProperties }, resolve);
  switch (schema.type) {
    case "number": return numberOf(schema);
    case "integer": return integerOf(schema);
    case "boolean": return fc.boolean();
    case "null": return fc.constant(null);
    // Names that only a service knows, such as those of metrics, are among the examples.
    case "string": return schema.examples ? fc.constantFrom(...schema.examples) : schema.pattern ? fc.stringMatching(new RegExp(schema.pattern)) : fc.string({ maxLength: schema.maxLength ?? 20, unit: "grapheme" });
    case "array": return fc.array(fromSchema(schema.items, resolve), { minLength: schema.minItems ?? 0, maxLength: schema.maxItems ?? largestList });
    case "object": return objectOf(schema, resolve);
    default: throw new Error(`a schema that is not understood: ${JSON.stringify(schema)}`);
  }
}

const strange = fc.oneof(
  fc.jsonValue({ maxDepth: 3 }),
  fc.constantFrom(null, true, "", "rigid", [], {}, [[]], [null], -1, 0, -0, 1.5, 1e308, -1e308, 5e-324, 2 ** 53, 2 ** 63, 1e9, 4294967296, "=1+1", "\u0000", "\ud800"),
);

/** Copy of a value with something strange in one place; random numbers lead to the place. */
function replaced(value, route, other) {
  if (route.length === 0 || typeof value !== "object" || value === null) return other;
  const keys = Object.keys(value);
  if (keys.length === 0) return other;
  const key = keys[route[0] % keys.length];
  const copy = Array.isArray(value) ? [...value] : { ...value };
  copy[key] = replaced(value[key], route.slice(1), other);
  return copy;
}

/** Values of which one part is not as it should be. */
export function broken(values) {
  const routes = fc.array(fc.nat(60), { minLength: 1, maxLength: 5 });
  return fc.oneof(
    { weight: 4, arbitrary: fc.tuple(values, routes, strange).map(([value, route, other]) => replaced(value, route, other)) },
    { weight: 1, arbitrary: fc.tuple(values, fc.string({ maxLength: 8 }), strange).map(([value, key, other]) => ({ ...value, [key]: other })) },
    { weight: 1, arbitrary: strange },
  );
}
