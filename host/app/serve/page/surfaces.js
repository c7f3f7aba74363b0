// The list of surfaces with their pictures, which are tiles of /surfaces.jpg in the list's order.
import {html, Dialog, useState, useStore} from './ui.js';
import {store} from './store.js';

const columns = 8;

export function Thumbnail({name}) {
  const formulas = useStore(store, (s) => s.formulas);
  const index = formulas.findIndex((f) => f.name === name), rows = Math.ceil(formulas.length / columns);
  if (index < 0) return html`<span class="thumbnail" aria-hidden="true"></span>`;
  const part = (i, n) => (n > 1 ? (100 * i) / (n - 1) + '%' : '0');
  const style = {backgroundSize: `${100 * columns}% ${100 * rows}%`, backgroundPosition: `${part(index % columns, columns)} ${part(Math.floor(index / columns), rows)}`};
  return html`<span class="thumbnail filled" aria-hidden="true" style=${style}></span>`;
}

export function SurfaceList({chosen, onChoose, onClose}) {
  const formulas = useStore(store, (s) => s.formulas);
  const [wanted, want] = useState('');
  const shown = formulas.filter((f) => (f.name + ' ' + f.title).toLowerCase().includes(wanted.toLowerCase()));
  return html`<${Dialog} title="Surfaces" onClose=${onClose} wide>
    <input type="search" class="filter" aria-label="Find a surface" placeholder="Find a surface" value=${wanted} onInput=${(e) => want(e.target.value)} />
    <ul class="surfaces">${shown.map((f) => html`<li key=${f.name}><button type="button" data-surface=${f.name} aria-pressed=${f.name === chosen} title=${f.title} onClick=${() => onChoose(f.name)}>
      <${Thumbnail} name=${f.name} /><b>${f.name}</b><small>${f.kind === 'escape' ? 'escape time' : f.kind === 'folded' ? 'folds' : 'closed form'}</small></button></li>`)}</ul>
  </${Dialog}>`;
}
