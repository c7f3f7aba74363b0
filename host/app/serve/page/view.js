// The picture: a canvas that shows the newest frame; mouse, fingers and keys on it move the camera.
import {html, useEffect, useRef, useState, useStore} from './ui.js';
import {store} from './store.js';
import * as cam from './camera.js';
import {Overlay} from './overlay.js';

const keys = {
  w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], e: [0, 1, 0], q: [0, -1, 0],
};
const arrows = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
let gestures = 0;

function setCamera(camera, gesture) {
  const before = store.state.resolved.camera;
  store.update({resolved: {...store.state.resolved, camera}});
  store.edit(cam.cameraChanges(camera, before), gesture);
}
const camera = () => store.state.resolved?.camera;

/** One finger or button orbits; with Shift, the right button or two fingers it moves; with Alt it looks around; two fingers dolly. */
class Drag {
  pointers = new Map();
  moved = 0;

  down(event, canvas) {
    if (!camera()) return;
    canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.pointers.size === 1) {
      this.moved = 0;
      this.gesture = 'view' + ++gestures;
    }
    this.way = event.button === 0 && !event.shiftKey ? (event.altKey ? 'look' : 'orbit') : 'pan';
  }
  move(event, canvas) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY], dx = now[0] - before[0], dy = now[1] - before[1];
    this.moved += Math.hypot(dx, dy);
    if (this.moved < 4) return;
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    this.pointers.set(event.pointerId, now);
    if (!camera()) return;
    if (other) this.pinch(before, now, other, canvas);
    else setCamera(this.moveOne(dx, dy, canvas), this.gesture);
  }
  moveOne(dx, dy, canvas) {
    const c = camera();
    if (this.way === 'orbit') return cam.orbit(c, -0.4 * dx, -0.4 * dy);
    const perPixel = c.fov / canvas.clientHeight;
    if (this.way === 'look') return cam.look(c, dx * perPixel, dy * perPixel);
    const depth = cam.length(cam.sub(c.target, c.position));
    return cam.move(c, cam.scale(cam.unproject(c, canvas.clientHeight, dx, dy, depth), -1));
  }
  pinch(before, now, other, canvas) {
    const d = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
    this.way = 'pan';
    const moved = this.moveOne((now[0] - before[0]) / 2, (now[1] - before[1]) / 2, canvas);
    setCamera(cam.dolly(moved, d(before) / Math.max(1, d(now))), this.gesture);
  }
  up(event) {
    const click = this.pointers.delete(event.pointerId) && this.moved < 4 && this.way !== 'pan';
    return click && this.pointers.size === 0;
  }
}

/** The picture's pixel under the pointer. */
function pixelAt(event, canvas) {
  const box = canvas.getBoundingClientRect();
  const clamp = (v, n) => Math.max(0, Math.min(n - 1, Math.floor(v)));
  return [clamp(((event.clientX - box.left) / box.width) * canvas.width, canvas.width),
          clamp(((event.clientY - box.top) / box.height) * canvas.height, canvas.height)];
}

async function pickAt(event, canvas) {
  store.update({picking: true});
  const picked = await store.pick(...pixelAt(event, canvas));
  store.update({picking: false, picked, selection: picked.object ? picked.object.at : store.state.selection});
  if (picked.error) store.notice(picked.error);
  return picked;
}

async function lookThere(event, canvas) {
  const picked = await pickAt(event, canvas);
  const c = camera();
  if (!picked.object || !c) return;
  setCamera(cam.withView(c, c.position, picked.position), 'look' + ++gestures);
}

/** Moves the camera while keys are held. */
function useFlight() {
  const held = useRef(new Set());
  const running = useRef(false);
  const advance = (dt) => {
    let next = camera();
    if (!next) return;
    for (const key of held.current) {
      if (keys[key]) next = cam.fly(next, ...keys[key].map((v) => 0.6 * dt * v));
      if (arrows[key]) next = cam.orbit(next, ...arrows[key].map((v) => 60 * dt * v));
      if (key === '+' || key === '-') next = cam.dolly(next, Math.exp((key === '+' ? -1 : 1) * dt));
    }
    setCamera(next, held.gesture);
  };
  const step = (last) => (time) => {
    running.current = held.current.size > 0;
    if (!running.current) return;
    advance(Math.min(0.1, (time - last) / 1000));
    requestAnimationFrame(step(time));
  };
  const down = (event) => {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.ctrlKey || event.metaKey || !(keys[key] || arrows[key] || key === '+' || key === '-')) return;
    event.preventDefault();
    if (held.current.size === 0) held.gesture = 'keys' + ++gestures;
    if (!held.current.has(key)) {
      held.current.add(key);
      advance(0.05);  // a short touch moves too
    }
    if (!running.current) {
      running.current = true;
      requestAnimationFrame((time) => step(time - 16)(time));
    }
  };
  const up = (event) => held.current.delete(event.key.length === 1 ? event.key.toLowerCase() : event.key);
  const leave = () => held.current.clear();
  return {down, up, leave};
}

/** The largest size at which the picture fits into its container. */
function useFit(place, width, height) {
  const [size, setSize] = useState([0, 0]);
  useEffect(() => {
    const fit = () => {
      const box = place.current.getBoundingClientRect();
      const s = Math.min(box.width / width, box.height / height);
      setSize([Math.floor(width * s), Math.floor(height * s)]);
    };
    const watch = new ResizeObserver(fit);
    watch.observe(place.current);
    fit();
    return () => watch.disconnect();
  }, [width, height]);
  return size;
}

export function View() {
  const resolved = useStore(store, (s) => s.resolved);
  const picking = useStore(store, (s) => s.picking);
  const place = useRef(), canvas = useRef(), drag = useRef(new Drag());
  const flight = useFlight();
  const width = resolved?.width ?? 640, height = resolved?.height ?? 480;
  const size = useFit(place, width, height);
  useEffect(() => {
    store.onPicture = async (header, blob) => {
      const bitmap = await createImageBitmap(blob);
      const c = canvas.current;
      if (c.width !== header.width || c.height !== header.height) {
        c.width = header.width;
        c.height = header.height;
      }
      c.getContext('2d').drawImage(bitmap, 0, 0);
      bitmap.close();
      Object.assign(c.dataset, {version: header.version, settled: header.settled, block: header.block, frame: Number(c.dataset.frame ?? 0) + 1});
      store.update({picture: header});
    };
    const wheel = (event) => {
      event.preventDefault();
      if (camera()) setCamera(cam.dolly(camera(), Math.exp(0.0015 * event.deltaY * (event.deltaMode ? 20 : 1))), 'wheel' + Math.floor(Date.now() / 700));
    };
    canvas.current.addEventListener('wheel', wheel, {passive: false});
  }, []);
  const style = {width: size[0] + 'px', height: size[1] + 'px'};
  return html`<main class="view" ref=${place} aria-label="Picture">
    <div class="frame" style=${style}>
      <canvas ref=${canvas} tabindex="0" class=${picking ? 'picking' : ''} role="img"
        aria-label="The scene. Drag to orbit, with Shift to move, wheel to come nearer; arrow keys orbit, W A S D Q E fly; click picks, double click looks there."
        onPointerDown=${(e) => drag.current.down(e, canvas.current)}
        onPointerMove=${(e) => drag.current.move(e, canvas.current)}
        onPointerUp=${(e) => drag.current.up(e) && pickAt(e, canvas.current)}
        onPointerCancel=${(e) => drag.current.up(e)}
        onDblClick=${(e) => lookThere(e, canvas.current)}
        onContextMenu=${(e) => e.preventDefault()}
        onKeyDown=${flight.down} onKeyUp=${flight.up} onBlur=${flight.leave}></canvas>
      <${Overlay} width=${width} height=${height} shown=${size} />
    </div>
  </main>`;
}
