// One widget for each kind of value. Each takes {label, value, fallback, onSet(value, gesture), help, at}: if `value` is undefined, the
// document does not set it, and `fallback` (the default) is shown.
import {html, useEffect, useRef, useState, useStore, plain} from './ui.js';
import {store} from './store.js';
import {CodeEditor} from './editor.js';

let gestures = 0;
let ids = 0;
export const useId = () => useRef('f' + ++ids).current;

/** A row: label with help, the widget, a button that resets the value to its default, and the server's refusal. */
export function Row({id, label, help, at, isSet, onReset, wide, children}) {
  const error = useStore(store, (s) => (s.error && at && (s.error.at === at || s.error.at.startsWith(at + '/')) ? s.error : null));
  return html`<div class=${'row' + (wide ? ' wide' : '') + (error ? ' bad' : '')}>
    <label for=${id} title=${help}>${label}</label>
    <div class="control">${children}</div>
    <button type="button" class="reset" title="Back to the default" aria-label=${'Reset ' + label} hidden=${!isSet || !onReset} onClick=${onReset}>↺</button>
    ${error && html`<p class="error" role="alert">${error.reason}</p>`}
  </div>`;
}

/** The slider's ends: the limits if they are close, else a range around the value; null: no slider. */
function sliderRange(min, max, value) {
  if (value === undefined) return null;
  if (min !== undefined && max !== undefined && max - min <= 200) return [min, max];
  if (min >= 0) return [min, Math.min(max ?? Infinity, Math.max(1, 4 * Math.abs(value || 0.25)))];
  return null;
}

/** The text typed into a field, kept until the field loses focus or an undo changes the scene. */
function useTyped() {
  const [text, setText] = useState(null);
  const scenes = useStore(store, (s) => s.scenes);
  useEffect(() => setText(null), [scenes]);
  return [text, setText];
}

export function NumberInput({id, value, min, max, step, label, faint, onSet}) {
  const [text, setText] = useTyped();
  const gesture = useRef('');
  const input = (event) => {
    setText(event.target.value);
    const number = event.target.valueAsNumber;
    if (Number.isFinite(number)) onSet(number, gesture.current);
  };
  return html`<input id=${id} type="number" aria-label=${label} class=${faint ? 'faint' : ''} value=${text ?? plain(value)} min=${min} max=${max}
    step=${step ?? 'any'} onFocus=${() => (gesture.current = 'number' + ++gestures)} onInput=${input} onBlur=${() => setText(null)} />`;
}

export function NumberField({label, value, fallback, min, max, soft, whole, unit, help, at, onSet, onReset}) {
  const id = useId(), shown = value ?? fallback;
  const gesture = useRef(''), range = useRef(null);
  const ends = range.current ?? soft ?? sliderRange(min, max, shown);
  const step = ends ? (whole ? 1 : (ends[1] - ends[0]) / 200) : undefined;
  const slide = (event) => onSet(Number(event.target.valueAsNumber.toPrecision(6)), gesture.current);
  const begin = () => {
    gesture.current = 'slide' + ++gestures;
    range.current = ends;
  };
  return html`<${Row} id=${id} label=${label} help=${help} at=${at} isSet=${value !== undefined} onReset=${onReset}>
    ${ends && html`<input type="range" aria-label=${label + ', slider'} min=${ends[0]} max=${ends[1]} step=${step} value=${shown}
      onPointerDown=${begin} onFocus=${begin} onInput=${slide} onBlur=${() => (range.current = null)} onChange=${() => (range.current = null)} />`}
    <span class="number"><${NumberInput} id=${id} label=${label} value=${shown} min=${min} max=${max} step=${whole ? 1 : 'any'}
      faint=${value === undefined} onSet=${(v, g) => onSet(whole ? Math.round(v) : v, g)} />${unit && html`<i>${unit}</i>`}</span>
  </${Row}>`;
}

export function VectorField({label, value, fallback, names = ['x', 'y', 'z'], min, max, help, at, onSet, onReset}) {
  const id = useId(), shown = value ?? fallback;
  const set = (i) => (number, gesture) => onSet(names.map((_, k) => (k === i ? number : shown?.[k] ?? 0)), gesture);
  return html`<${Row} id=${id} label=${label} help=${help} at=${at} isSet=${value !== undefined} onReset=${onReset}>
    <div class="vector">${names.map((name, i) => html`<span class=${'number' + (name.length > 2 ? ' long' : '')}><b aria-hidden="true">${name}</b>
      <${NumberInput} id=${i ? undefined : id} label=${label + ' ' + name} value=${shown?.[i]} min=${min} max=${max} faint=${value === undefined} onSet=${set(i)} /></span>`)}</div>
  </${Row}>`;
}

const toScreen = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const fromScreen = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const hex = (color) => '#' + color.map((v) => Math.round(255 * Math.max(0, Math.min(1, toScreen(v)))).toString(16).padStart(2, '0')).join('');
const fromHex = (text) => [1, 3, 5].map((i) => Number(fromScreen(parseInt(text.slice(i, i + 2), 16) / 255).toPrecision(4)));

/** Edits a colour. Scene colours are linear; the picker's colours are sRGB. */
export function ColorInput({label, value, faint, onSet}) {
  const gesture = useRef('');
  return html`<div class="vector color"><input type="color" aria-label=${label} value=${hex(value)} onFocus=${() => (gesture.current = 'color' + ++gestures)}
      onInput=${(e) => onSet(fromHex(e.target.value), gesture.current)} />
    ${['r', 'g', 'b'].map((name, i) => html`<span class="number"><b aria-hidden="true">${name}</b><${NumberInput} label=${`${label}, ${name}, linear`}
      value=${value[i]} min=${0} faint=${faint} onSet=${(v, g) => onSet(value.map((c, k) => (k === i ? v : c)), g)} /></span>`)}</div>`;
}
export function ColorField({label, value, fallback, help, at, onSet, onReset}) {
  return html`<${Row} label=${label} help=${help} at=${at} isSet=${value !== undefined} onReset=${onReset}>
    <${ColorInput} label=${label} value=${value ?? fallback ?? [1, 1, 1]} faint=${value === undefined} onSet=${onSet} /></${Row}>`;
}

export function BooleanField({label, value, fallback, help, at, onSet, onReset}) {
  const id = useId();
  return html`<${Row} id=${id} label=${label} help=${help} at=${at} isSet=${value !== undefined} onReset=${onReset}>
    <input id=${id} type="checkbox" checked=${value ?? fallback ?? false} onChange=${(e) => onSet(e.target.checked)} /></${Row}>`;
}

export function ChoiceField({label, value, fallback, choices, help, at, onSet, onReset}) {
  const id = useId(), shown = value ?? fallback ?? '';
  const all = choices.includes(shown) ? choices : [shown, ...choices];
  return html`<${Row} id=${id} label=${label} help=${help} at=${at} isSet=${value !== undefined} onReset=${onReset}>
    <select id=${id} value=${shown} onChange=${(e) => onSet(e.target.value)}>${all.map((c) => html`<option value=${c}>${c === '' ? '–' : c}</option>`)}</select></${Row}>`;
}

export function TextField({label, value, fallback, help, at, onSet, onReset}) {
  const id = useId();
  const [text, setText] = useTyped();
  return html`<${Row} id=${id} label=${label} help=${help} at=${at} isSet=${value !== undefined} onReset=${onReset}>
    <input id=${id} type="text" value=${text ?? value ?? fallback ?? ''} onInput=${(e) => setText(e.target.value)} onBlur=${() => setText(null)}
      onChange=${(e) => onSet(e.target.value || undefined)} /></${Row}>`;
}

/** Edits a text of the formula language. Sends it when typing pauses; marks an error at its line and column. */
export function CodeField({label, value, help, at, words, onReset}) {
  const id = useId();
  const error = useStore(store, (s) => store.drafts.error(at) ?? (s.error?.at === at ? s.error : null));
  const place = error && /line (\d+), column (\d+)/.exec(error.reason);
  const marked = place && {line: Number(place[1]), column: Number(place[2]), reason: error.reason};
  const reset = onReset && (() => {
    store.drafts.drop(at);
    onReset();
  });
  const line = place && (store.drafts.text(at).split('\n')[place[1] - 1] ?? '');
  return html`<${Row} id=${id} label=${label} help=${help} at=${error ? undefined : at} isSet=${value !== undefined} onReset=${reset} wide>
    <${CodeEditor} id=${id} at=${at} label=${label} words=${words} place=${marked} />
    <p class="error" role="alert">${error && html`${place && html`<pre>${line}${'\n' + ' '.repeat(Math.max(0, place[2] - 1))}^</pre>`}${error.reason}`}</p>
  </${Row}>`;
}
