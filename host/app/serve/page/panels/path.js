// A camera path: views that are kept with their frames become tracks of the scene ("animate"), which `sundog render --frames` renders.
import {html, Group, Button, useEffect, useRef, useState, useStore} from '../ui.js';
import {store} from '../store.js';
import {NumberField} from '../fields.js';
import {withView} from '../camera.js';

const parts = ['position', 'target'];
const pointerOf = (part) => '/camera/' + part;
const isOfPath = (track) => parts.some((part) => track.value === pointerOf(part));

/** The views of the path by rising frame: [{frame, position, target}]. */
export function viewsOf(document) {
  const tracks = parts.map((part) => (document?.animate ?? []).find((track) => track.value === pointerOf(part) && track.keys));
  if (!tracks[0] || !tracks[1]) return [];
  return tracks[0].keys.map((key, i) => ({frame: key.frame, position: key.value, target: tracks[1].keys[i]?.value ?? key.value}));
}

function write(views) {
  const others = (store.state.document.animate ?? []).filter((track) => !isOfPath(track));
  const keys = (part) => views.map((view) => ({frame: view.frame, value: view[part]}));
  const tracks = views.length ? parts.map((part) => ({type: 'smooth', value: pointerOf(part), keys: keys(part)})) : [];
  const all = [...tracks, ...others];
  store.set('/animate', all.length ? all : undefined);
}

/** Keeps the camera's view at that frame. */
export function keepView(camera, frame) {
  const {position, target} = store.state.resolved.camera;
  const view = {frame, position: position.slice(), target: target.slice()};
  const views = [...viewsOf(store.state.document).filter((v) => v.frame !== frame), view].sort((a, b) => a.frame - b.frame);
  const needed = ['position', 'target'].filter((part) => !store.state.document.camera?.[part]);
  if (needed.length) store.edit(needed.map((part) => ({at: pointerOf(part), value: view[part]})));
  write(views);
}

/** The view between two others: straight, which is near enough to look at. */
function viewAt(views, frame) {
  const after = views.findIndex((v) => v.frame >= frame);
  if (after <= 0) return after === 0 ? views[0] : views[views.length - 1];
  const a = views[after - 1], b = views[after], t = (frame - a.frame) / (b.frame - a.frame);
  const mix = (part) => a[part].map((v, i) => v + t * (b[part][i] - v));
  return {position: mix('position'), target: mix('target')};
}

export function CameraPath({camera, onChange}) {
  const document = useStore(store, (s) => s.document), file = useStore(store, (s) => s.file);
  const views = viewsOf(document), last = views[views.length - 1];
  const [step, setStep] = useState(24);
  const [playing, play] = useState(false);
  const began = useRef(null);
  useEffect(() => {
    if (!playing) return;
    const before = camera, gesture = 'play' + Math.round(performance.now());
    let stopped = false;
    began.current = performance.now();
    const tick = () => {
      if (stopped) return;
      const frame = views[0].frame + ((performance.now() - began.current) / 1000) * 24;
      if (frame > last.frame) return play(false);
      const view = viewAt(views, frame);
      onChange(withView(camera, view.position, view.target), gesture);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
    return () => {
      stopped = true;
      onChange(before, gesture);
    };
  }, [playing]);
  const range = views.length > 1 ? `${Math.ceil(views[0].frame)}..${Math.floor(last.frame)}` : '';
  return html`<${Group} title=${`Path (${views.length} view${views.length === 1 ? '' : 's'})`} id="path">
    <${NumberField} label="Frames apart" value=${step} min=${1} max=${200} whole onSet=${setStep} help="How many frames lie between a view and the next one." />
    <div class="line"><${Button} kind="primary" label="Keep this view" onClick=${() => keepView(camera, last ? last.frame + step : 0)} />
      <${Button} label=${playing ? 'Stop' : 'Play'} disabled=${views.length < 2} onClick=${() => play(!playing)} />
      <${Button} label="Clear" disabled=${!views.length} onClick=${() => write([])} /></div>
    <ul class="objects" aria-label="Views of the path">${views.map((view) => html`<li key=${view.frame} class="item"><div><button type="button" class="object" title="Show this view"
        onClick=${() => onChange(withView(camera, view.position, view.target))}><span>Frame ${view.frame}</span><i>${view.position.map((v) => Number(v.toPrecision(3))).join(', ')}</i></button></div>
      <${Button} kind="small" label="✕" title=${`Remove frame ${view.frame}`} onClick=${() => write(views.filter((v) => v !== view))} /></li>`)}</ul>
    ${range && html`<p class="hint">Save the scene, then: <code>sundog render ${file.replace(/\.[^.]*$/, '')}.json -o frame.png --frames ${range}</code></p>`}
  </${Group}>`;
}
