// The balance of light groups: sliders that change the picture without rendering it again.
import {html, Group, Button, useStore} from '../ui.js';
import {store} from '../store.js';
import {NumberField, Row} from '../fields.js';

/** "key=2,#ffddaa" for ['key', {factor: 2, color: '#ffddaa'}], as for `sundog mix --light`. */
const written = ([name, {factor, color}]) => `${name}=${factor},${color}`;
function read(lights) {
  return new Map(lights.map((light) => {
    const [, name, factor, color] = /^(.*)=([^,]*),(.*)$/.exec(light);
    return [name, {factor: Number(factor), color}];
  }));
}

export function BalancePanel() {
  const groups = useStore(store, (s) => s.resolved?.light_groups) ?? [];
  const balance = read(useStore(store, (s) => s.lights));
  if (groups.length === 0) return null;
  const one = {factor: 1, color: '#ffffff'};
  const set = (name, change) => {
    balance.set(name, {...one, ...balance.get(name), ...change});
    store.balance([...balance].filter(([, light]) => light.factor !== 1 || light.color !== one.color).map(written));
  };
  return html`<${Group} title="Balance of light groups" id="balance"
      actions=${html`<${Button} kind="small" label="Reset" title="All groups as the scene has them" onClick=${() => store.balance([])} />`}>
    ${[...groups, 'rest'].map((name) => {
      const light = balance.get(name), {color} = light ?? one;
      return html`<${NumberField} label=${name} value=${light?.factor} fallback=${1} min=${0} max=${1e6} soft=${[0, 4]} onSet=${(v) => set(name, {factor: v})}
          onReset=${() => set(name, {factor: 1})} help="The light of this group is multiplied by this." />
        <${Row} label=${name + ', colour'} isSet=${color !== one.color} onReset=${() => set(name, {color: one.color})}><input type="color" aria-label=${name + ', colour'} value=${color} onInput=${(e) => set(name, {color: e.target.value})} /></${Row}>`;
    })}
    <p class="hint">Sliders develop the picture anew and draw nothing. Save → Copy the command line has the balance for <code>sundog mix</code>.</p>
  </${Group}>`;
}
