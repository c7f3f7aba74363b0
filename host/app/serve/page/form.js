// Makes a form for any part of the scene from its schema: objects become groups, alternatives a choice, lists rows.
import {html, Group, Button, useStore} from './ui.js';
import {store} from './store.js';
import {join} from './pointer.js';
import {branch, changesFor, definition, fits, isTextureName, missing, resolve, sample, unitOf, variants, words} from './schema.js';
import {BooleanField, ChoiceField, CodeField, ColorField, NumberField, Row, TextField, VectorField} from './fields.js';

const isColor = (s) => ['color', 'share_color', 'light_color'].includes(s.kind);
const isVector = (s) => s.type === 'array' && s.minItems === s.maxItems && s.minItems <= 4 && ['number', 'integer'].includes(resolve(s.items).type);
/** The presets of a 'material' or 'texture'. */
export const presetNames = (kind) => definition('preset_' + kind).properties.preset.enum;
const withPresets = (kind) => [...new Set([...Object.keys(store.state.document[kind + 's'] ?? {}), ...presetNames(kind)])];
const names = {
  material_name: () => withPresets('material'),
  formula_name: () => store.state.formulas.map((f) => f.name),
};
/** The table of the document that a key refers to, found in its description. */
const tableOf = (description = '') => /^The name of (?:the|a) (medium|mesh|field|material)\b/.exec(description)?.[1];
const tables = {medium: 'media', mesh: 'meshes', field: 'fields', material: 'materials'};

/** A widget for the value at `at`. `schema` may be a reference; `required` values have no reset. */
export function Field({schema, at, value, label, required, onSet, onReset}) {
  const s = resolve(schema);
  const common = {
    label, at, value, help: s.description, fallback: s.default,
    onSet: onSet || ((next, gesture) => store.set(at, next, gesture)),
    onReset: required ? undefined : onReset ?? (() => store.set(at, undefined)),
  };
  if (isTextureName(s)) return html`<${ChoiceField} ...${common} choices=${withPresets('texture')} />`;
  const table = tables[tableOf(s.description)];
  if (names[s.kind]) return html`<${ChoiceField} ...${common} choices=${names[s.kind]()} />`;
  if (table) return html`<${ChoiceField} ...${common} choices=${['', ...Object.keys(store.state.document[table] ?? {})]} onSet=${(v) => store.set(at, v || undefined)} />`;
  if (s.kind === 'formula_text') return html`<${CodeField} ...${common} />`;
  if (isColor(s)) return html`<${ColorField} ...${common} />`;
  if (isVector(s)) return html`<${VectorField} ...${common} names=${['x', 'y', 'z', 'w'].slice(0, s.minItems)} />`;
  if (s.type === 'number' || s.type === 'integer')
    return html`<${NumberField} ...${common} min=${s.minimum ?? s.exclusiveMinimum} max=${s.maximum ?? s.exclusiveMaximum} whole=${s.type === 'integer'} unit=${unitOf(s.description)} />`;
  if (s.type === 'boolean') return html`<${BooleanField} ...${common} />`;
  if (s.enum) return html`<${ChoiceField} ...${common} choices=${s.enum} />`;
  if (s.anyOf) return html`<${Alternatives} ...${common} schema=${s} required=${required} />`;
  if (s.type === 'array') return html`<${List} ...${common} schema=${s} />`;
  if (s.type === 'string') return html`<${TextField} ...${common} />`;
  return html`<${Part} ...${common} schema=${schema} required=${required} />`;
}

const altName = (schema) => {
  const s = resolve(schema);
  if (isColor(s)) return 'colour';
  if (s.type === 'number' || s.kind === 'coefficient' || s.kind === 'share') return 'number';
  if (s.kind) return words(s.kind.replace(/_(or|name).*/, '')).toLowerCase();
  return s.type === 'array' ? 'vector' : s.type ?? 'value';
};

/** A value of one of several kinds: a choice of the kind, and a widget for the value. */
function Alternatives({schema, at, value, label, help, fallback, required, onReset}) {
  const options = schema.anyOf.flatMap((one) => (resolve(one).anyOf ? resolve(one).anyOf : [one]));
  const given = value ?? fallback;
  const chosen = given === undefined ? -1 : options.findIndex((one) => fits(one, given));
  const kinds = options.map(altName);
  const pick = (event) => {
    const index = Number(event.target.value);
    if (index < 0) store.set(at, undefined);
    else store.edit(changesFor(options[index], at));
  };
  return html`<div class="alternatives">
    <${Row} label=${label} help=${help} at=${at} isSet=${value !== undefined} onReset=${required ? undefined : onReset}>
      <select aria-label=${label + ', kind'} value=${chosen} onChange=${pick}>
        ${!required && html`<option value="-1">default</option>`}${kinds.map((kind, i) => html`<option value=${i}>${kind}</option>`)}</select>
    </${Row}>
    ${chosen >= 0 && html`<div class="indent"><${Field} schema=${options[chosen]} at=${at} value=${given} label=${words(kinds[chosen])} required=${true} /></div>`}
  </div>`;
}

function List({schema, at, value, label, help}) {
  const items = value ?? [];
  return html`<${Group} title=${`${label} (${items.length})`} id=${at} open=${items.length < 8}>
    ${items.map((item, i) => html`<div class="item"><div><${Field} schema=${schema.items} at=${join(at, i)} value=${item} label=${`${i + 1}`} required=${true} /></div>
      <${Button} kind="small" label="✕" title=${`Remove ${label} ${i + 1}`} disabled=${items.length <= (schema.minItems ?? 0)} onClick=${() => store.set(join(at, i), undefined)} /></div>`)}
    <${Button} kind="small" label="Add" title=${help} onClick=${() => store.set(at, [...items, items.length ? items[items.length - 1] : sample(schema.items)])} />
  </${Group}>`;
}

/** An object of the scene as a group; a missing object can be added. */
function Part({schema, at, value, label, help, required, onReset}) {
  const s = resolve(schema);
  if (value === undefined)
    return html`<${Row} label=${label} help=${help} at=${at}><${Button} kind="small" label="Add" title=${help} onClick=${() => store.edit(changesFor(schema, at))} /></${Row}>`;
  if (s.properties || variants(schema)) {
    const remove = !required && html`<${Button} kind="small" label="Remove" title=${'Remove ' + label} onClick=${onReset} />`;
    return html`<${Group} title=${label} id=${at} actions=${remove}><${Fields} schema=${schema} at=${at} value=${value} /></${Group}>`;
  }
  return html`<${Json} at=${at} value=${value} label=${label} help=${help} onReset=${onReset} />`;
}

/** A value without a widget of its own, as JSON text. */
function Json({at, value, label, help, onReset}) {
  const send = (event) => {
    try {
      store.set(at, JSON.parse(event.target.value));
    } catch (error) {
      store.update({error: {at, reason: error.message}});
    }
  };
  return html`<${Row} label=${label} help=${help} at=${at} isSet onReset=${onReset} wide><textarea aria-label=${label} rows="3" spellcheck="false" onChange=${send}>${JSON.stringify(value)}</textarea></${Row}>`;
}

/** Fields for all keys of an object; `only` and `without` select among them. An object with a "type" shows its type's keys. */
export function Fields({schema, at, value, only, without = [], defaults = {}}) {
  const types = variants(schema);
  const s = types ? types[value?.type] ?? {} : branch(schema, value);
  const required = s.required ?? [];
  const needs = (key) => s.if?.properties?.[key] && ((next) => {  // sets the key, and others that its new value requires
    const chosen = {...value, [key]: next}, more = s.if.properties[key].const === next ? missing({...s, required: []}, chosen) : {};
    const gone = next === 'dielectric' && value.color !== undefined && !('ambient' in value || 'diffuse' in value) ? [{at: at + '/color'}] : [];  // glass has no colour
    store.edit([...gone, ...Object.entries({...more, [key]: next}).map(([name, v]) => ({at: join(at, name), value: v}))]);
  });
  const partners = s.dependentRequired ?? {};  // "from" and "to": both or none
  const withPartners = (key) => [key, ...Object.keys(partners).filter((other) => partners[other].includes(key) && value?.[other] !== undefined)];
  const rivals = (key) => {
    const has = (one) => one.required?.includes(key), ways = s.oneOf?.some(has) ? s.oneOf.filter((one) => !has(one)) : [];
    const all = [...(s.not?.anyOf ?? []).filter(has), ...ways].flatMap((one) => one.required ?? []);
    return [...new Set(all)].filter((other) => other !== key && value?.[other] !== undefined);
  };
  const instead = (key) => {  // the key replaces those that exclude it, and adds those that it requires
    const gone = [key, ...(partners[key] ?? [])].flatMap(rivals).flatMap(withPartners).filter((other) => other !== key);
    const kept = Object.fromEntries(Object.entries(value ?? {}).filter(([other]) => !gone.includes(other)));
    const alone = (partners[key] ?? []).some((other) => !(other in kept));
    return (gone.length > 0 || alone) && ((next, gesture) => store.edit([...gone.map((other) => ({at: join(at, other)})),
      ...Object.entries({...missing(s, {...kept, [key]: next}), [key]: next}).map(([name, v]) => ({at: join(at, name), value: v}))], gesture));
  };
  const keys = Object.keys(s.properties ?? {}).filter((key) => (!only || only.includes(key)) && !without.includes(key) && key !== '$schema');
  const setType = (type) => {
    const kept = Object.fromEntries(Object.entries(value).filter(([key]) => key in (types[type].properties ?? {})));
    delete kept.type;
    const changes = changesFor(types[type], at, kept), last = changes[changes.length - 1];
    store.edit([...changes.slice(0, -1), {at, value: {...last.value, type}}]);
  };
  return html`<div class="fields">
    ${types && !without.includes('type') && html`<${ChoiceField} label="Type" at=${at + '/type'} value=${value?.type} choices=${Object.keys(types)} onSet=${setType} />`}
    ${keys.filter((key) => !(types && key === 'type')).map((key) => html`<${Field} key=${at + key} schema=${key in defaults ? {...s.properties[key], default: defaults[key]} : s.properties[key]} at=${join(at, key)} value=${value?.[key]}
      label=${words(key)} required=${required.includes(key)} onSet=${needs(key) || instead(key)} onReset=${() => store.edit(withPartners(key).map((one) => ({at: join(at, one)})))} />`)}
  </div>`;
}

/** A table of named things (materials, media...): each a group, with buttons to add and remove. */
export function Table({name, schema, title, open}) {
  const table = useStore(store, (st) => st.document?.[name]) ?? {};
  const add = () => {
    let next = title.toLowerCase();
    for (let i = 2; next in table; ++i) next = `${title.toLowerCase()} ${i}`;
    store.edit(changesFor(schema, join('/' + name, next)));
  };
  return html`${Object.entries(table).map(([key, value]) => html`<${Group} key=${key} title=${key} id=${name + '/' + key} open=${open === key}
      actions=${html`<${Button} kind="small" label="Remove" title=${`Remove ${key}`} onClick=${() => store.set(join('/' + name, key), undefined)} />`}>
    <${Fields} schema=${schema} at=${join('/' + name, key)} value=${value} /></${Group}>`)}
    <${Button} kind="small" label=${'Add ' + title.toLowerCase()} onClick=${add} />`;
}
