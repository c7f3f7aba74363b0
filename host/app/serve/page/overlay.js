// Draws lights and the selected field's interval over the picture, projected with its camera. Both can be dragged.
import {html, useRef, useStore} from './ui.js';
import {store} from './store.js';
import {project, unproject, add, scale} from './camera.js';

let gestures = 0;

const rows = (m) => [0, 1, 2, 3].map((i) => m.slice(4 * i, 4 * i + 4));
const place = (m, p) => rows(m).slice(0, 3).map((r) => r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3]);

const corner = (box, i) => [0, 1, 2].map((axis) => (i >> axis & 1 ? box.max : box.min)[axis]);
const edges = [...Array(8).keys()].flatMap((i) => [0, 1, 2].filter((axis) => !(i >> axis & 1)).map((axis) => [i, i | 1 << axis]));

/** A handle that is dragged in the picture: `move(dx, dy, started)` gets pixels of the picture, and the value of `start()`. */
function Handle({at, label, shape, factor, start, move, children}) {
  const state = useRef(null);
  const down = (event) => {
    event.stopPropagation();
    event.currentTarget.setPointerCapture(event.pointerId);
    state.current = {x: event.clientX, y: event.clientY, begun: start(), gesture: 'handle' + ++gestures};
  };
  const drag = (event) => {
    if (!state.current) return;
    const s = state.current;
    move((event.clientX - s.x) * factor, (event.clientY - s.y) * factor, s.begun, s.gesture);
  };
  const key = (event) => {
    const way = {ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, -8], ArrowDown: [0, 8]}[event.key];
    if (!way) return;
    event.preventDefault();
    event.stopPropagation();
    move(way[0] * factor, way[1] * factor, start(), 'handlekeys');
  };
  return html`<g class=${'handle ' + shape} transform=${`translate(${at.x} ${at.y})`} tabindex="0" role="button" aria-label=${label}
      onPointerDown=${down} onPointerMove=${drag} onPointerUp=${() => (state.current = null)} onKeyDown=${key}>
    <title>${label}</title><g transform=${`scale(${factor})`}>${children}</g></g>`;
}

function LightHandle({light, index, camera, width, height, factor}) {
  const at = project(camera, width, height, light.position);
  if (!at || at.x < 0 || at.y < 0 || at.x > width || at.y > height) return null;
  const pointer = `/lights/${index}/position`;
  const move = (dx, dy, begun, gesture) =>
    store.set(pointer, add(begun, unproject(camera, height, dx, dy, at.depth)).map((v) => Number(v.toPrecision(6))), gesture);
  return html`<${Handle} at=${at} factor=${factor} shape="light" label=${`Light ${index + 1}, ${light.type}: drag to move`}
      start=${() => light.position} move=${move}>
    <circle r="11" class="halo" /><circle r="5" /></${Handle}>`;
}

/** One face of the interval, which moves along its axis. */
function FaceHandle({object, axis, side, camera, width, height, factor}) {
  const {interval, world, at: pointer} = object;
  const middle = [0, 1, 2].map((i) => (interval.min[i] + interval.max[i]) / 2);
  middle[axis] = interval[side][axis];
  const step = middle.slice();
  step[axis] += 1;
  const here = project(camera, width, height, place(world, middle));
  const there = project(camera, width, height, place(world, step));
  if (!here || !there) return null;
  const way = [there.x - here.x, there.y - here.y], square = way[0] ** 2 + way[1] ** 2;
  const move = (dx, dy, begun, gesture) => {
    if (square < 1) return;
    const value = begun[side][axis] + (dx * way[0] + dy * way[1]) / square;
    const limit = side === 'min' ? Math.min(value, begun.max[axis] - 1e-3) : Math.max(value, begun.min[axis] + 1e-3);
    const next = {min: begun.min.slice(), max: begun.max.slice()};
    next[side][axis] = Number(limit.toPrecision(5));
    store.set(pointer + '/interval', next, gesture);
  };
  return html`<${Handle} at=${here} factor=${factor} shape=${'face axis' + axis} label=${`Interval, ${side} of ${'xyz'[axis]}: drag to move`}
    start=${() => interval} move=${move}><rect x="-5" y="-5" width="10" height="10" rx="2" /></${Handle}>`;
}

function IntervalBox({object, camera, width, height, factor}) {
  const corners = [...Array(8).keys()].map((i) => project(camera, width, height, place(object.world, corner(object.interval, i))));
  return html`<g class="interval">
    ${edges.map(([a, b]) => corners[a] && corners[b] &&
      html`<line x1=${corners[a].x} y1=${corners[a].y} x2=${corners[b].x} y2=${corners[b].y} stroke-width=${factor} />`)}
    ${[0, 1, 2].flatMap((axis) => ['min', 'max'].map((side) =>
      html`<${FaceHandle} ...${{object, axis, side, camera, width, height, factor}} />`))}
  </g>`;
}

export function Overlay({width, height, shown}) {
  const resolved = useStore(store, (s) => s.resolved);
  const lights = useStore(store, (s) => s.document?.lights);
  const selection = useStore(store, (s) => s.selection);
  const tab = useStore(store, (s) => s.tab);
  if (!resolved || !shown[0]) return null;
  const camera = resolved.camera, factor = width / shown[0];
  const common = {camera, width, height, factor};
  const object = tab === 'build' && resolved.objects.find((o) => o.at === selection && o.interval);
  return html`<svg class="overlay" viewBox=${`0 0 ${width} ${height}`} aria-label="Handles">
    ${tab === 'light' && (lights ?? []).map((light, index) => Array.isArray(light.position) &&
      html`<${LightHandle} light=${light} index=${index} ...${common} />`)}
    ${object && html`<${IntervalBox} object=${object} ...${common} />`}
  </svg>`;
}
