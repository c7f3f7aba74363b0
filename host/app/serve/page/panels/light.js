// Light: ambient, directional, point and all other lights; the environment; fog.
import {html, Group, Button, useState, useStore} from '../ui.js';
import {store} from '../store.js';
import {Fields, Field} from '../form.js';
import {sample, variants, words} from '../schema.js';
import {join} from '../pointer.js';
import {BalancePanel} from './balance.js';
import {Presets, lights as presets, setLights} from '../presets.js';

const starts = {
  spot: {target: [0, 0, 0]},
  rectangle: {position: [0, 3, 0], direction: [0, -1, 0]},
  disk: {position: [0, 3, 0], direction: [0, -1, 0]},
  sphere: {position: [0, 3, 0]},
};

export function LightPanel() {
  const lights = useStore(store, (s) => s.document?.lights) ?? [];
  const environment = useStore(store, (s) => s.document?.environment);
  const world = useStore(store, (s) => s.document?.world);
  const [type, setType] = useState('point');
  const types = variants({$ref: '#/$defs/light'});
  const add = () => store.set('/lights/-', {type, ...sample(types[type], 0, starts[type])});
  return html`
    ${lights.map((light, i) => html`<${Group} key=${i} title=${`${i + 1}. ${words(light.type)}`} id=${'light' + i}
        actions=${html`<${Button} kind="small" label="Remove" title=${`Remove light ${i + 1}`} onClick=${() => store.set(join('/lights', i), undefined)} />`}>
      <${Fields} schema=${{$ref: '#/$defs/light'}} at=${join('/lights', i)} value=${light} /></${Group}>`)}
    ${lights.length === 0 && html`<p class="hint">There are no lights: the scene is dark but for what shines by itself.</p>`}
    <div class="line"><select aria-label="Type of the new light" value=${type} onChange=${(e) => setType(e.target.value)}>${Object.keys(types).map((t) => html`<option>${t}</option>`)}</select>
      <${Button} label="Add light" onClick=${add} /></div>
    <${BalancePanel} />
    <${Presets} title="Presets of lights" list=${presets} onTake=${setLights} />
    <${Group} title="All around, and fog" id="around" open=${!!environment}>
      <${Field} schema=${{$ref: '#/$defs/environment', description: 'Light from all around.'}} at="/environment" value=${environment} label="Environment" />
      <${Field} schema=${{$ref: '#/$defs/world'}} at="/world" value=${world} label="World" />
    </${Group}>`;
}
