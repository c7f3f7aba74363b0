// Exports Preact and htm for all modules, and the basic widgets.
import {h, render, Fragment} from './vendor/preact.module.js';
import {useState, useEffect, useRef, useMemo, useLayoutEffect} from './vendor/hooks.module.js';
import htm from './vendor/htm.module.js';

export const html = htm.bind(h);
export {render, Fragment, useState, useEffect, useRef, useMemo, useLayoutEffect};

/** Returns what `select` takes from the store; renders again when that changes. */
export function useStore(store, select) {
  const [, redraw] = useState(0);
  const last = useRef();
  last.current = select(store.state);
  useLayoutEffect(() => store.listen(() => {
    if (!Object.is(select(store.state), last.current)) redraw((n) => n + 1);
  }), []);
  return last.current;
}

export function Button({label, title, onClick, disabled, pressed, kind = ''}) {
  return html`<button type="button" class=${'button ' + kind} title=${title} disabled=${disabled}
    aria-pressed=${pressed} onClick=${onClick}>${label}</button>`;
}

/** A group that folds; it stays as the user has left it. */
const folded = new Map();
export function Group({title, id = title, open = true, actions, children}) {
  const [shown, show] = useState(folded.has(id) ? folded.get(id) : open);
  const toggle = (event) => {
    const next = event.currentTarget.open;
    folded.set(id, next);
    show(next);
  };
  return html`<div class="group"><details open=${shown} onToggle=${toggle}>
    <summary class=${actions ? 'with-actions' : ''}><span>${title}</span></summary>
    ${shown && html`<div class="group-body">${children}</div>`}
  </details>${actions && html`<span class="actions">${actions}</span>`}</div>`;
}

/** A dialog, closed by Escape, by its button, or by a click beside it. */
export function Dialog({title, onClose, children, wide}) {
  const box = useRef();
  useEffect(() => {
    box.current.showModal();
  }, []);
  return html`<dialog ref=${box} class=${wide ? 'wide' : ''} aria-label=${title} onClose=${onClose}
      onClick=${(e) => e.target === box.current && box.current.close()}>
    <header><h2>${title}</h2><${Button} label="Close" onClick=${() => box.current.close()} /></header>
    <div class="dialog-body">${children}</div>
  </dialog>`;
}

export const short = (n) => {
  if (n === null || n === undefined || !isFinite(n)) return '–';
  for (const [unit, size] of [['G', 1e9], ['M', 1e6], ['k', 1e3]])
    if (Math.abs(n) >= size) return (n / size).toPrecision(3) + ' ' + unit;
  return Number.isInteger(n) ? String(n) : n.toPrecision(3);
};

export const seconds = (s) => (s < 0 ? '–' : s < 1 ? Math.round(1000 * s) + ' ms' : s.toFixed(s < 10 ? 2 : 1) + ' s');

/** A number as text with at most seven digits, which hides rounding errors. */
export const plain = (n) => (typeof n === 'number' ? String(Number(n.toPrecision(7))) : '');
