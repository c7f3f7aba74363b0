// Presets: frequently used materials, lights and render settings, as parts of a scene. Choosing a preset is an ordinary edit.
import {presetNames} from './form.js';
import {html, Button, useState} from './ui.js';
import {store} from './store.js';
import {join} from './pointer.js';

const glossy = (coefficient, exponent) => ({specular: {coefficient, exponent}});

/** Presets of materials. Phong presets keep the material's colour; the others are presets of the scene format. */
const painted = {
  matte: {ambient: 0.2, diffuse: 0.9},
  plastic: {ambient: 0.2, diffuse: 0.8, ...glossy(0.5, 40)},
  lacquer: {ambient: 0.15, diffuse: 0.75, ...glossy(0.8, 200), reflection: 0.12},
};
export const materials = () => ({...painted, ...Object.fromEntries(presetNames('material').map((preset) => [preset, {preset}]))});

/** Presets that replace all lights. */
export const lights = {
  'Lamp from the left': [{type: 'ambient', intensity: 0.6}, {type: 'point', position: [-3, 4, 3]}],
  'Key, fill and rim': [{type: 'ambient', intensity: 0.4}, {type: 'directional', direction: [-0.8, -1, -0.6], color: [1, 0.95, 0.86], intensity: 0.9},
    {type: 'directional', direction: [1, -0.3, -0.4], color: [0.7, 0.82, 1], intensity: 0.35}, {type: 'directional', direction: [0.2, -0.6, 1], intensity: 0.5}],
  'Low sun': [{type: 'ambient', color: [0.5, 0.6, 0.9], intensity: 0.6}, {type: 'directional', direction: [-1, -0.25, -0.4], color: [1, 0.62, 0.32], intensity: 1.2}],
  'Soft window': [{type: 'ambient', intensity: 0.5}, {type: 'rectangle', position: [-3, 3, 2], direction: [1, -1, -0.7], size: [2, 2], intensity: 6, samples: 4}],
};

/** Presets of render settings; they set only these keys. */
export const qualities = {
  Draft: {samples: 1, max_depth: 3},
  Good: {samples: 4, max_depth: 6},
  Best: {samples: 16, max_depth: 10},
};

let gestures = 0;

export function setMaterial(at, before, name) {
  const keeps = name in painted && before?.color !== undefined;
  store.set(at, keeps ? {color: before.color, ...painted[name]} : materials()[name]);
}
export const setLights = (name) => store.set('/lights', structuredClone(lights[name]));
export const setQuality = (name) =>
  store.edit(Object.entries(qualities[name]).map(([key, value]) => ({at: join('/render', key), value})), 'quality' + ++gestures);

/** A list of presets and a button that applies the chosen one. */
export function Presets({title, list, onTake}) {
  const names = Object.keys(list);
  const [name, choose] = useState(names[0]);
  return html`<div class="line"><select aria-label=${title} value=${name} onChange=${(e) => choose(e.target.value)}>${names.map((n) => html`<option>${n}</option>`)}</select>
    <${Button} kind="small" label="Use preset" title=${`${title}: take ${name}`} onClick=${() => onTake(name)} /></div>`;
}
