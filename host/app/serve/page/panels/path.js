// A camera path: views saved with their frames become tracks of the scene ("animate"), which `sundog render --frames` renders.
import {html, Group, Button, useEffect, useRef, useState, useStore} from '../ui.js';
import {store} from '../store.js';
import {NumberField} from '../fields.js';
import {withView} from '../camera.js';
import {valueAt} from '../tracks.js';

const parts = ['position', 'target'];
const pointerOf = (part) => '/camera/' + part;
const tracksOf = (document) => document?.animate ?? [];
const isOwn = (track, part) => track.value === pointerOf(part) && track.keys?.length > 0 && track.keys.every((key) => key.value?.length === 3);
const ownTrack = (document, part) => tracksOf(document).find((track) => isOwn(track, part));

/** The index of the first other track that moves the camera's position or target, which rules out saving views; -1: none. */
export const otherTrack = (document) =>
  tracksOf(document).findIndex((track) => parts.some((part) => `${track.value}/`.startsWith(`${pointerOf(part)}/`) && track !== ownTrack(document, part)));

/** The path's views in ascending order of frames, one for each key: [{frame, position, target}]. */
export function viewsOf(document) {
  const tracks = parts.map((part) => ownTrack(document, part));
  const frames = [...new Set(tracks.flatMap((track) => track?.keys.map((key) => key.frame) ?? []))].sort((a, b) => a - b);
  return frames.map((frame) => viewAt(document, frame));
}

/** The camera's view in a frame; a part without a track stands still. */
function viewAt(document, frame) {
  const view = {frame};
  for (const part of parts) {
    const track = ownTrack(document, part);
    view[part] = track ? valueAt(track, frame) : (document.camera?.[part] ?? store.state.resolved.camera[part]);
  }
  return view;
}

/** Changes the keys of the path's own tracks; other tracks stay. `change` returns a part's new keys from its old ones. */
function write(change) {
  const document = store.state.document;
  const made = new Map();
  for (const part of parts) {
    const track = ownTrack(document, part), keys = change(track?.keys ?? [], part);
    made.set(part, keys.length ? {type: 'smooth', value: pointerOf(part), ...track, keys} : undefined);
  }
  const kept = tracksOf(document).map((track) => {
    const part = parts.find((p) => track === ownTrack(document, p));
    return part ? made.get(part) : track;
  });
  const fresh = parts.filter((part) => !ownTrack(document, part)).map((part) => made.get(part));
  const all = [...fresh, ...kept].filter(Boolean);
  store.set('/animate', all.length ? all : undefined);
}

/** Quotes a word for a shell if necessary. */
const shellWord = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

const without = (keys, frame) => keys.filter((key) => key.frame !== frame);

/** Saves the camera's view for this frame. */
export function keepView(camera, frame) {
  const {position, target} = store.state.resolved.camera, view = {position: position.slice(), target: target.slice()};
  const last = viewsOf(store.state.document).at(-1);
  const needed = parts.filter((part) => !store.state.document.camera?.[part]);
  if (needed.length) store.edit(needed.map((part) => ({at: pointerOf(part), value: view[part]})));
  const begun = (keys, part) => (keys.length || !last ? keys : [{frame: last.frame, value: last[part]}]);  // a part that stood still so far
  write((keys, part) => [...without(begun(keys, part), frame), {frame, value: view[part]}].sort((a, b) => a.frame - b.frame));
}

export function CameraPath({camera, onChange}) {
  const document = useStore(store, (s) => s.document), file = useStore(store, (s) => s.file);
  const views = viewsOf(document), last = views[views.length - 1], other = otherTrack(document);
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
      const frame = views[0].frame + ((performance.now() - began.current) / 1000) * (document.frames_per_second ?? 24);
      if (frame > last.frame) return play(false);
      const view = viewAt(document, frame);
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
    <div class="line"><${Button} kind="primary" label="Keep this view" disabled=${other >= 0} onClick=${() => keepView(camera, last ? last.frame + step : 0)} />
      <${Button} label=${playing ? 'Stop' : 'Play'} disabled=${views.length < 2} onClick=${() => play(!playing)} />
      <${Button} label="Clear" disabled=${!views.length} onClick=${() => write(() => [])} /></div>
    <ul class="objects" aria-label="Views of the path">${views.map((view) => html`<li key=${view.frame} class="item"><div><button type="button" class="object" title="Show this view"
        onClick=${() => onChange(withView(camera, view.position, view.target))}><span>Frame ${view.frame}</span><i>${view.position.map((v) => Number(v.toPrecision(3))).join(', ')}</i></button></div>
      <${Button} kind="small" label="✕" title=${`Remove frame ${view.frame}`} onClick=${() => write((keys) => without(keys, view.frame))} /></li>`)}</ul>
    ${other >= 0 && html`<p class="hint">/animate/${other} moves the camera too (${document.animate[other].type}): take it out of the scene to keep views.</p>`}
    ${range && html`<p class="hint">Save the scene, then: <code>sundog render ${shellWord(file.replace(/\.[^.]*$/, '') + '.json')} -o frame.png --frames ${range}</code></p>`}
  </${Group}>`;
}
