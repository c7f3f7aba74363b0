// Build: an object's surface, its parameters, the interval that bounds it, its material, and smoothing.
import {html, Group, Button, useEffect, useRef, useState, useStore} from '../ui.js';
import {store} from '../store.js';
import {get, join} from '../pointer.js';
import {definition, sample, variants, words} from '../schema.js';
import {NumberField, VectorField, CodeField} from '../fields.js';
import {Fields, Table} from '../form.js';
import {SurfaceList, Thumbnail} from '../surfaces.js';
import {Presets, materials, setMaterial} from '../presets.js';

/** All objects with their pointers; a group's objects follow it. */
export function allObjects(document, at = '/objects', depth = 0) {
  return (get(document, at) ?? []).flatMap((object, i) => {
    const here = join(at, i);
    return [{at: here, object, depth}, ...(object.type === 'group' ? allObjects(document, join(here, 'objects'), depth + 1) : [])];
  });
}
export const titleOf = ({object}) => object.name ?? (object.formula ? `${object.formula}` : object.mesh ?? object.file ?? object.type);

function useSelected() {
  const document = useStore(store, (s) => s.document);
  const selection = useStore(store, (s) => s.selection);
  const all = allObjects(document);
  const chosen = all.find((o) => o.at === selection) ?? all.find((o) => ['fractal', 'formula', 'hybrid'].includes(o.object.type)) ?? all[0];
  if (chosen && chosen.at !== selection) setTimeout(() => store.update({selection: chosen.at}));
  return {all, chosen, document};
}

const namedIn = {mesh: 'meshes', field: 'fields', scatter: 'meshes'};  // types that refer to an entry of a table

/** Scrolls only the list, not the panel around it. */
function showIn(list, row) {
  if (!row) return;
  const outer = list.getBoundingClientRect(), inner = row.getBoundingClientRect();
  list.scrollTop += Math.min(0, inner.top - outer.top) + Math.max(0, inner.bottom - outer.bottom);
}

function ObjectList({all, chosen}) {
  const [type, setType] = useState('sphere'), [file, setFile] = useState('');
  const list = useRef();
  useEffect(() => showIn(list.current, list.current.querySelector('[aria-pressed=true]')), [chosen?.at]);
  const types = Object.keys(variants({$ref: '#/$defs/object'})).filter((t) => t !== 'native');
  const add = () => {
    const schema = variants({$ref: '#/$defs/object'})[type];
    const entry = namedIn[type] && Object.keys(store.state.document[namedIn[type]] ?? {})[0];
    if (namedIn[type] && !entry) return store.notice(`The scene has no ${namedIn[type]}: add one first, at Image → ${words(namedIn[type])}.`);
    const starts = {formula: {map: 'z = z^8 + c'}, hybrid: {}, lathe: {profile: [[0, 0], [0.4, 0], [0.5, 0.4], [0.25, 0.9], [0, 1]]}, mesh: {mesh: entry}, field: {field: entry}, scatter: {on: entry}, model: {file}};
    const object = {type, ...sample(schema), ...starts[type]};
    const materials = Object.keys(store.state.document.materials ?? {});
    const changes = [];
    if (materials.length === 0) changes.push({at: '/materials/white', value: {}});
    if (schema.properties?.material) object.material = materials[0] ?? 'white';
    store.edit([...changes, {at: '/objects/-', value: object}]);
    store.update({selection: `/objects/${store.state.document.objects.length - 1}`});
  };
  return html`<${Group} title=${`Objects (${all.length})`} id="objects">
    <ul ref=${list} class="objects" aria-label="Objects">${all.map((o) => html`<li key=${o.at}><button type="button"
      aria-pressed=${o.at === chosen?.at} class=${'object depth' + Math.min(3, o.depth)} onClick=${() => store.update({selection: o.at})}>
      <span>${titleOf(o)}</span><i>${o.object.type}</i></button></li>`)}</ul>
    ${type === 'model' && html`<div class="line"><input type="text" aria-label="File of the new model" placeholder="model.glb, from the scene's folder" value=${file} onInput=${(e) => setFile(e.target.value)} /></div>`}
    <div class="line"><select aria-label="Type of the new object" value=${type} onChange=${(e) => setType(e.target.value)}>${types.map((t) => html`<option>${t}</option>`)}</select>
      <${Button} kind="small" label="Add" onClick=${add} />
      <${Button} kind="small" label="Remove" title="Remove the selected object" disabled=${!chosen} onClick=${() => store.set(chosen.at, undefined)} /></div>
  </${Group}>`;
}

function Parameter({at, value, fallback, label, min, max, whole, meaning, onReset}) {
  const common = {label, at, value, fallback, help: meaning, onSet: (v, g) => store.set(at, v, g), onReset};
  if (Array.isArray(value ?? fallback)) return html`<${VectorField} ...${common} names=${['x', 'y', 'z', 'w'].slice(0, (value ?? fallback).length)} />`;
  const v = Math.abs(value ?? fallback) || 1;
  const near = min !== undefined && max - min <= 2000;
  return html`<${NumberField} ...${common} min=${min} max=${max} whole=${whole} soft=${near ? [min, max] : [-2 * v, 2 * v]} />`;
}

function ListedSurface({at, object}) {
  const formulas = useStore(store, (s) => s.formulas);
  const [listed, list] = useState(false);
  const formula = formulas.find((f) => f.name === object.formula);
  const choose = (name) => {
    list(false);
    if (name === object.formula) return;
    const {parameters, interval, iterations, bailout, ...kept} = object;
    store.set(at, {...kept, formula: name});
  };
  return html`<button type="button" class="surface" onClick=${() => list(true)} title="Choose a surface">
      <${Thumbnail} name=${object.formula} /><span><b>${object.formula}</b><small>${formula?.title}</small></span><i>Change</i></button>
    ${listed && html`<${SurfaceList} chosen=${object.formula} onChoose=${choose} onClose=${() => list(false)} />`}
    ${formula?.parameters.map((p) => html`<${Parameter} key=${p.name} at=${at + '/parameters/' + p.name} label=${p.name} value=${object.parameters?.[p.name]}
      fallback=${p.default} min=${p.min} max=${p.max} whole=${p.whole} meaning=${p.meaning} onReset=${() => store.set(at + '/parameters/' + p.name, undefined)} />`)}
    <${Fields} schema=${definition('fractal')} at=${at} value=${object} only=${['iterations', 'bailout', 'derivative', 'safety']}
      defaults=${{iterations: formula?.iterations ?? 8, bailout: formula?.bailout ?? 16, safety: formula?.safety ?? 1}} />`;
}

function OwnFormula({at, object}) {
  const [name, setName] = useState('');
  const schema = definition('formula').properties;
  const functions = useStore(store, (s) => s.functions);
  const add = () => {
    if (/^[A-Za-z_]\w*$/.test(name)) store.set(join(at + '/parameters', name), {value: 1, min: -5, max: 5});
    setName('');
  };
  return html`${['start', 'map', 'distance'].map((key) => html`<${CodeField} key=${at + key} label=${words(key)} at=${at + '/' + key} value=${object[key]} help=${schema[key].description}
      words=${[...Object.keys(object.parameters ?? {}), 'p', 'z', 'c']} onReset=${() => store.set(at + '/' + key, undefined)} />`)}
    <h2 class="minor">Parameters</h2>
    ${Object.entries(object.parameters ?? {}).map(([key, p]) => {
      const whole = typeof p === 'object' && !Array.isArray(p);
      const place = join(at + '/parameters', key);
      return html`<div class="item" key=${key}><div><${Parameter} at=${whole ? place + '/value' : place} label=${key} value=${whole ? p.value : p}
        min=${whole ? p.min : undefined} max=${whole ? p.max : undefined} whole=${whole && p.whole} meaning="A parameter of this formula." /></div>
        <${Button} kind="small" label="✕" title=${'Remove ' + key} onClick=${() => store.set(place, undefined)} /></div>`;
    })}
    <div class="line"><input type="text" aria-label="Name of a new parameter" placeholder="name" value=${name} onInput=${(e) => setName(e.target.value)} />
      <${Button} kind="small" label="Add parameter" onClick=${add} /></div>
    <${Fields} schema=${definition('formula')} at=${at} value=${object} only=${['space', 'estimate', 'derivative', 'normalize', 'iterations', 'bailout', 'safety']}
      defaults=${{iterations: 8, bailout: 16, safety: object.map ? 0.9 : 1}} />
    <${Group} title="Functions of the language" open=${false}><dl class="functions">${functions.map((f) => html`<dt><code>${f.call}</code></dt><dd>${f.meaning}</dd>`)}</dl></${Group}>`;
}

/** The box that bounds a distance field, axis by axis. */
function Interval({at, object, resolved}) {
  const shown = object.interval ?? resolved?.interval;
  if (!shown) return null;
  const set = (side, axis) => (value, gesture) => {
    const next = {min: shown.min.slice(), max: shown.max.slice()};
    next[side][axis] = value;
    if (next.min[axis] < next.max[axis]) store.set(at + '/interval', next, gesture);
  };
  return html`<${Group} title="Interval" id="interval">
    ${[0, 1, 2].map((axis) => html`<${NumberRow} axis=${axis} shown=${shown} isSet=${!!object.interval} set=${set} onReset=${() => store.set(at + '/interval', undefined)} />`)}
  </${Group}>`;
}
function NumberRow({axis, shown, isSet, set, onReset}) {
  const name = 'XYZ'[axis];
  return html`<${VectorField} label=${name} names=${['from', 'to']} value=${isSet ? [shown.min[axis], shown.max[axis]] : undefined} fallback=${[shown.min[axis], shown.max[axis]]}
    help=${`Where the surface is built along ${name}: outside it is cut off.`} onReset=${onReset}
    onSet=${(v, g) => (v[0] !== shown.min[axis] ? set('min', axis)(v[0], g) : set('max', axis)(v[1], g))} />`;
}

const surfaceKeys = ['parameters', 'iterations', 'bailout', 'derivative', 'safety', 'interval', 'formula', 'start', 'map', 'distance', 'space', 'estimate', 'normalize', 'type'];

export function BuildPanel() {
  const {all, chosen, document} = useSelected();
  const resolved = useStore(store, (s) => s.resolved);
  if (!chosen) return html`<${ObjectList} all=${all} />`;
  const {at, object} = chosen, found = resolved?.objects.find((o) => o.at === at);
  const field = ['fractal', 'formula'].includes(object.type);
  const material = object.material ?? found?.material;
  return html`
    <${ObjectList} all=${all} chosen=${chosen} />
    ${field && html`<${Group} title="Surface" id="surface" key=${'surface' + at}>${object.type === 'fractal' ? html`<${ListedSurface} at=${at} object=${object} />` : html`<${OwnFormula} at=${at} object=${object} />`}</${Group}>`}
    <${Interval} at=${at} object=${object} resolved=${found} />
    <${Group} title=${field ? 'Surface, further' : titleOf(chosen)} id="object" open=${!field} key=${'object' + at}>
      <${Fields} schema=${{$ref: '#/$defs/object'}} at=${at} value=${object} without=${field ? surfaceKeys : ['objects']} /></${Group}>
    ${material && get(document, join('/materials', material)) && html`<${Group} title=${`Material: ${material}`} id="material">
      <${Presets} title="Presets of materials" list=${materials()} onTake=${(name) => setMaterial(join('/materials', material), get(document, join('/materials', material)), name)} />
      <${Fields} schema=${{$ref: '#/$defs/any_material'}} at=${join('/materials', material)} value=${get(document, join('/materials', material))} /></${Group}>`}
    <${Group} title="Smoothing" id="smoothing"><${Fields} schema=${{$ref: '#/$defs/render'}} at="/render" value=${document.render ?? {}}
      only=${['samples', 'filter', 'filter_radius', 'adaptive', 'subsample']} /></${Group}>
    <${Group} title="All materials" id="materials" open=${false}><${Table} name="materials" schema=${{$ref: '#/$defs/any_material'}} title="Material" /></${Group}>`;
}
