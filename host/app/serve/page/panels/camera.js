// Camera: its position and view, and two commands: turn about a vector by an angle, and move by a vector.
import {html, Group, Button, useState, useStore} from '../ui.js';
import {store} from '../store.js';
import {VectorField, NumberField, ChoiceField} from '../fields.js';
import {Fields} from '../form.js';
import {CameraPath} from './path.js';
import {cameraChanges, dolly, move, turnAbout} from '../camera.js';

function change(next, gesture = '') {
  const before = store.state.resolved.camera;
  store.update({resolved: {...store.state.resolved, camera: next}});
  store.edit(cameraChanges(next, before), gesture);
}

function Turn({camera}) {
  const [axis, setAxis] = useState([0, 1, 0]);
  const [degrees, setDegrees] = useState(15);
  const [about, setAbout] = useState('target');
  return html`<${Group} title="Turn about a vector" id="turn">
    <${VectorField} label="Vector" value=${axis} onSet=${setAxis} help="The axis that the camera turns about." />
    <${NumberField} label="Angle" value=${degrees} min=${-180} max=${180} unit="°" onSet=${setDegrees} help="Degrees, to the left about an axis that points at you." />
    <${ChoiceField} label="Through" value=${about} choices=${['target', 'camera']} onSet=${setAbout} help="Which point the axis goes through: turn about what is looked at, or look around." />
    <div class="line"><${Button} label="Turn" kind="primary" disabled=${Math.hypot(...axis) === 0} onClick=${() => change(turnAbout(camera, axis, degrees, about))} />
      <${Button} label="Turn back" disabled=${Math.hypot(...axis) === 0} onClick=${() => change(turnAbout(camera, axis, -degrees, about))} /></div>
  </${Group}>`;
}

function Move({camera}) {
  const [by, setBy] = useState([0, 0, 0.1]);
  return html`<${Group} title="Move by a vector" id="move">
    <${VectorField} label="Vector" value=${by} onSet=${setBy} help="The way that the camera and its target move, in the scene's units." />
    <div class="line"><${Button} label="Move" kind="primary" onClick=${() => change(move(camera, by))} />
      <${Button} label="Move back" onClick=${() => change(move(camera, by.map((v) => -v)))} /></div>
  </${Group}>`;
}

export function CameraPanel() {
  const camera = useStore(store, (s) => s.resolved?.camera);
  const given = useStore(store, (s) => s.document?.camera) ?? {};
  if (!camera) return null;
  const away = camera.position.map((v, i) => v - camera.target[i]);
  const from = (axis, side) => () => {
    const d = Math.hypot(...away), position = camera.target.slice();
    position[axis] += side * d;
    const up = axis === 1 ? [0, 0, -side] : [0, 1, 0];
    change({...camera, position, up});
  };
  const placed = given.position ? given : {...given, position: camera.position, target: camera.target};
  return html`
    <${Group} title="View" id="view">
      <${VectorField} label="Position" value=${camera.position} help="The camera's place." at="/camera/position" onSet=${(v, g) => change({...camera, position: v}, g)} />
      <${VectorField} label="Target" value=${camera.target} help="The point in the middle of the picture." at="/camera/target" onSet=${(v, g) => change({...camera, target: v}, g)} />
      <${Fields} schema=${{$ref: '#/$defs/camera'}} at="/camera" value=${placed} only=${['up', 'fov', 'focal_length', 'film_width', 'orthographic', 'near', 'far']} />
      <div class="line" role="group" aria-label="Look from">${['X', 'Y', 'Z'].flatMap((name, axis) => [1, -1].map((side) =>
        html`<${Button} kind="small" label=${(side > 0 ? '+' : '−') + name} title=${`Look from ${side > 0 ? '+' : '-'}${name.toLowerCase()}`} onClick=${from(axis, side)} />`))}
        <${Button} kind="small" label="Nearer" onClick=${() => change(dolly(camera, 0.8))} /><${Button} kind="small" label="Farther" onClick=${() => change(dolly(camera, 1.25))} /></div>
    </${Group}>
    <${Turn} camera=${camera} />
    <${Move} camera=${camera} />
    <${CameraPath} camera=${camera} onChange=${change} />
    <${Group} title="Lens and motion" id="lens" open=${false}><${Fields} schema=${{$ref: '#/$defs/camera'}} at="/camera" value=${placed} only=${['lens', 'moves_to']} /></${Group}>`;
}
