// Reads the scene's JSON Schema for the panels: references, variants by "type" or by fit, defaults, and small valid values.
import {store} from './store.js';

const defs = () => store.state.schema.$defs;
export const nameOf = (schema) => schema?.$ref?.replace('#/$defs/', '');

/** The schema with its references resolved; keys beside a reference take precedence. */
function refer(schema) {
  let out = schema ?? {};
  for (let i = 0; out.$ref && i < 10; ++i) {
    const {$ref, ...rest} = out;
    out = {...defs()[nameOf({$ref})], ...rest, kind: out.kind ?? nameOf({$ref})};
  }
  return out;
}

/** The choices of a schema that names them alone. */
function namesOf(schema) {
  const s = refer(schema);
  return s.anyOf?.flatMap(namesOf) ?? s.enum ?? [s.const];
}

/** An object's schema with the rules of another one for the same object. */
const joined = (s, more) => ({
  ...more, ...s,
  properties: {...s.properties, ...more.properties, ...s.properties},  // keys of `s` come first
  required: [...(s.required ?? []), ...(more.required ?? [])],
  dependentRequired: {...more.dependentRequired, ...s.dependentRequired},
  not: s.not && more.not ? {anyOf: [...s.not.anyOf, ...more.not.anyOf]} : s.not ?? more.not,
});

/** The schema with its references resolved, and with what it takes in by "allOf", some of it only for a "type". */
export function resolve(schema, type) {
  const {allOf = [], ...own} = refer(schema);
  return allOf.filter((one) => !one.if || namesOf(one.if.properties.type).includes(type))
    .reduce((s, one) => {
      const more = resolve(one.then ?? one, type);
      return {...joined(s, more), ...(one.then && {description: more.description})};
    }, own);
}
export const definition = (name) => resolve({$ref: '#/$defs/' + name});

/** The variants of a schema whose objects differ by their "type": {sphere: schema, ...}; null for others. */
export function variants(schema) {
  if (!refer(schema).allOf?.some((one) => one.if)) return null;
  return Object.fromEntries(namesOf(resolve(schema).properties.type).map((type) => [type, joined({properties: {type: {const: type}}}, resolve(schema, type))]));
}

const holds = (condition, value) => (condition.required ?? []).every((key) => key in value) &&
  Object.entries(condition.properties ?? {}).every(([key, {const: wanted}]) => value[key] === wanted);

/** The schema that a value selects by "if", as a material's does. */
export function branch(schema, value = {}) {
  let s = resolve(schema);
  while (s.then?.$ref) s = resolve(holds(s.if, value) ? s.then : s.else);
  return s;
}

/** Whether a value fits a schema by its JSON type and limits, its required keys, and its known keys. */
export function fits(schema, value) {
  const s = resolve(schema, value?.type), closed = s.additionalProperties === false || s.unevaluatedProperties === false;
  if (s.anyOf) return s.anyOf.some((one) => fits(one, value));
  if (s.enum) return s.enum.includes(value);
  if ('const' in s) return s.const === value;
  if (s.type === 'number' || s.type === 'integer') return typeof value === 'number';
  if (s.type === 'array') return Array.isArray(value) && value.length >= (s.minItems ?? 0) && value.length <= (s.maxItems ?? 1e9) &&
    (!s.items || value.every((item) => fits(s.items, item)));
  if (s.type === 'object' || s.properties)
    return value !== null && typeof value === 'object' && !Array.isArray(value) &&
      (s.required ?? []).every((key) => key in value) &&
      (!closed || Object.keys(value).every((key) => key in (s.properties ?? {})));
  return !s.type || typeof value === s.type;
}

/** Whether a text names a texture. */
export const isTextureName = (s) => s.kind === 'texture_name' || (s.type === 'string' && /^The name of a texture\b/.test(s.description));

const firstTypes = {texture: 'checker', environment: 'sky'};  // types that need no file
const byKey = {direction: [-1, -1, -0.5], axis: [0, 1, 0], position: [3, 4, 3], ior: 1.5, from: [0, 0, 0], to: [0, 1, 0], min: [-1, -1, -1], max: [1, 1, 1]};
const newTexture = 'checks';

/** The keys that an object needs besides those of `kept`. Prefers the first alternative that needs neither a file nor a medium. */
function needed(s, kept) {
  const holds = Object.entries(s.if?.properties ?? {}).every(([key, {const: wanted}]) => kept[key] === wanted);
  const ways = [s.oneOf, s.anyOf, holds && s.then?.anyOf].filter((list) => list?.[0]?.required);
  const chosen = ways.flatMap((list) => (list.find((one) => one.required.every((key) => key in kept)) ??
    list.find((one) => !one.required.includes('file') && !one.required.includes('medium')) ?? list[0]).required);
  const partners = Object.keys(kept).flatMap((key) => s.dependentRequired?.[key] ?? []);
  return [...(s.required ?? []), ...chosen, ...partners].filter((key) => !(key in kept));
}

/** The required keys that an object lacks, with sample values. */
export function missing(schema, kept, depth = 0) {
  const s = resolve(schema);
  const keys = depth < 6 ? needed(s, kept).filter((key) => s.properties?.[key]) : [];
  return Object.fromEntries(keys.map((key) => [key, byKey[key] ?? sample(s.properties[key], depth + 1)]));
}

/** The changes that set a sample value at `at`, and add the texture that it needs if the scene has none. */
export function changesFor(schema, at, kept = {}) {
  const value = sample(schema, 0, kept), textures = Object.keys(store.state.document.textures ?? {});
  const makes = textures.length === 0 && JSON.stringify(value).includes(`"${newTexture}"`);
  return [...(makes ? [{at: '/textures/' + newTexture, value: {type: 'checker'}}] : []), {at, value}];
}

/** A small value that the schema accepts: its default, its first example, or a minimum of each part. An object includes `kept`. */
export function sample(schema, depth = 0, kept = {}) {
  const s = resolve(schema);
  if ('default' in s) return s.default;
  if ('const' in s) return s.const;
  if (s.enum) return s.enum[0];
  if (s.examples) return s.examples[0];
  const named = {color: [0.8, 0.8, 0.8], share_color: [0.8, 0.8, 0.8], vec3: [0, 0, 0], length: 1,
    interval: {min: [-1.5, -1.5, -1.5], max: [1.5, 1.5, 1.5]}, material_name: Object.keys(store.state.document?.materials ?? {})[0] ?? '',
    formula_name: 'mandelbulb'}[s.kind];
  if (named !== undefined) return named;
  if (isTextureName(s)) return Object.keys(store.state.document?.textures ?? {})[0] ?? newTexture;
  const types = variants(schema);
  if (types) {
    const type = firstTypes[s.kind] ?? Object.keys(types)[0];
    return {type, ...sample(types[type], depth + 1)};
  }
  if (s.anyOf && !s.properties) return sample(s.anyOf[0], depth + 1);
  if (s.type === 'number' || s.type === 'integer') return Math.max(s.minimum ?? s.exclusiveMinimum ?? 0, -1e9) > 0 ? s.minimum ?? 2 * s.exclusiveMinimum : Math.min(1, s.maximum ?? 1);
  if (s.type === 'boolean') return false;
  if (s.type === 'string') return 'name';
  if (s.type === 'array') return depth > 6 ? [] : Array.from({length: s.minItems ?? 0}, () => sample(s.items, depth + 1));
  return {...missing(s, kept, depth), ...kept};
}

/** "light_samples" as "Light samples". */
export const words = (key) => String(key).replace(/_/g, ' ').replace(/^./, (c) => c.toUpperCase());

/** The unit that a description states (degrees, pixels, ...). */
export function unitOf(description = '') {
  if (/\bdegrees?\b/i.test(description)) return '°';
  if (/\bin pixels\b/i.test(description)) return 'px';
  if (/\bMiB\b/.test(description)) return 'MiB';
  return '';
}
