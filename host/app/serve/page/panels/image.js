// Image: size, background, the settings of the render, and the scene's other tables.
import {html, Group, Button, useStore} from '../ui.js';
import {store} from '../store.js';
import {Fields, Table} from '../form.js';
import {Presets, qualities, setQuality} from '../presets.js';

const sizes = [[320, 320], [640, 480], [640, 640], [1280, 720], [1920, 1080]];

export function ImagePanel() {
  const document = useStore(store, (s) => s.document);
  return html`
    <${Group} title="Size and background" id="size">
      <div class="line" role="group" aria-label="Usual sizes">${sizes.map(([w, h]) => html`<${Button} kind="small" label=${`${w}×${h}`}
        onClick=${() => store.edit([{at: '/image/width', value: w}, {at: '/image/height', value: h}])} />`)}</div>
      <${Fields} schema=${{$ref: '#/$defs/image'}} at="/image" value=${document.image ?? {}} />
    </${Group}>
    <${Group} title="Render" id="render"><${Presets} title="Presets of quality" list=${qualities} onTake=${setQuality} /><${Fields} schema=${{$ref: '#/$defs/render'}} at="/render" value=${document.render ?? {}} /></${Group}>
    <${Group} title="Media" id="media" open=${false}><${Table} name="media" schema=${{$ref: '#/$defs/medium'}} title="Medium" /></${Group}>
    <${Group} title="Textures" id="textures" open=${false}><${Table} name="textures" schema=${{$ref: '#/$defs/texture'}} title="Texture" /></${Group}>
    <${Group} title="Fields" id="fields" open=${false}><${Table} name="fields" schema=${{$ref: '#/$defs/field_entry'}} title="Field" /></${Group}>
    <${Group} title="Meshes" id="meshes" open=${false}><${Table} name="meshes" schema=${{$ref: '#/$defs/mesh'}} title="Mesh" /></${Group}>`;
}
