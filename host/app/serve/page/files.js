// Opens scenes below the server's folder, dropped files and links; saves the scene and the picture; copies the command line and a link.
import {html, Dialog, Button, useEffect, useState} from './ui.js';
import {store} from './store.js';

function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
const stem = () => (store.state.file || 'scene').replace(/\.[^.]*$/, '');
const tell = (error) => store.notice(error.message);

export async function saveScene() {
  try {
    const text = await store.link.call('scene').then((answer) => answer.text(), (error) => {
      if (!store.state.document) throw error;
      return JSON.stringify(store.state.document, null, 2);  // without a server, the page has the scene
    });
    save(new Blob([text], {type: 'application/json'}), stem() + '.json');
    store.saved = JSON.parse(text);
    store.update({});
    return true;
  } catch (error) {
    tell(error);
    return false;
  }
}

/** Whether another scene may replace this one: yes if a file has all edits, else asks the user. */
function mayReplace() {
  store.drafts.sendAll();
  if (!store.unsaved && !store.drafts.refused()) return true;
  store.state.question?.(false);
  return new Promise((resolve) => store.update({question: resolve}));
}

export function QuestionDialog({answer}) {
  const say = (yes) => {
    store.update({question: null});
    answer(yes);
  };
  return html`<${Dialog} title="Edits that are not saved" onClose=${() => say(false)}>
    <p>Opening another scene drops the edits of ${store.state.file}.</p>
    <div class="line"><${Button} kind="primary" label="Save and open" onClick=${async () => (await saveScene()) && say(true)} />
      <${Button} label="Open without saving" onClick=${() => say(true)} />
      <${Button} label="Keep editing" onClick=${() => say(false)} /></div></${Dialog}>`;
}

/** Waits until the picture is settled, then saves it. */
export async function savePicture(format) {
  for (let tries = 0; tries < 600; ++tries) {
    try {
      return save(await (await store.link.call('picture?format=' + format)).blob(), `${stem()}.${format}`);
    } catch (error) {
      if (error.status !== 409) return tell(error);
      if (tries === 0) store.notice('The picture is saved when it is finished.');
      await new Promise((resolve) => setTimeout(resolve, 500));
    }
  }
}

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    store.notice(what + ' copied.');
  } catch {
    store.update({copyable: {what, text}});
  }
}
export async function copyCommand() {
  try {
    await copy((await (await store.link.call('command')).text()).trim(), 'Command line');
  } catch (error) {
    tell(error);
  }
}

const squeeze = async (text) => {
  const packed = await new Response(new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'))).arrayBuffer();
  return btoa(Array.from(new Uint8Array(packed), (c) => String.fromCharCode(c)).join('')).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
};
const unsqueeze = async (text) => {
  const bytes = Uint8Array.from(atob(text.replace(/-/g, '+').replace(/_/g, '/')), (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'))).text();
};

/** Copies a link with the whole scene in its fragment, which no server sees. */
export async function copyLink() {
  const scene = await squeeze(JSON.stringify(store.state.document));
  await copy(`${location.origin}/#token=${store.link.token}&name=${encodeURIComponent(store.state.file)}&scene=${scene}`, 'Link');
}

/** Sends a file; `read` returns its contents of `bytes` bytes. A file that is too large is not read. */
async function upload(read, name, bytes) {
  if (bytes > store.state.mostUpload) {
    const reason = `${name} has ${bytes} bytes, the viewer takes at most ${store.state.mostUpload}: put it into the folder that sundog was started in, and open it there`;
    return store.update({error: {at: '', reason}});
  }
  if (!(await mayReplace())) return;
  try {
    const body = await read();
    await store.link.call('scene?name=' + encodeURIComponent(name), {method: 'POST', body});
  } catch (error) {
    store.update({error: {at: '', reason: error.message}});
  }
}

/** Replaces the server's scene by the link's, once: removes it from the address. */
export async function openLink() {
  const parts = new URLSearchParams(location.hash.slice(1)), scene = parts.get('scene');
  if (parts.get('token')) history.replaceState(null, '', '#token=' + store.link.token);
  if (!scene) return;
  try {
    const text = await unsqueeze(scene);
    await store.until((state) => state.document !== null);
    await upload(() => text, parts.get('name') || 'link.json', text.length);
  } catch {
    store.notice('The link is damaged: its scene cannot be read.');
  }
}

export async function openFile(file) {
  const kind = '.' + file.name.toLowerCase().split('.').pop(), {models} = store.state;
  if (kind === '.json' || models.includes(kind)) return upload(() => file.arrayBuffer(), file.name, file.size);
  store.notice(`${file.name} is neither a scene (.json) nor a model (${models.join(', ')}).`);
}

export function OpenDialog({onClose}) {
  const [files, setFiles] = useState(null);
  const [wanted, want] = useState('');
  useEffect(() => {
    store.link.json('files').then(setFiles, tell);
  }, []);
  const open = async (file) => {
    onClose();
    if (await mayReplace()) store.say('open', {file});
  };
  const shown = (files ?? []).filter((f) => f.toLowerCase().includes(wanted.toLowerCase()));
  return html`<${Dialog} title="Open" onClose=${onClose}>
    <input type="search" class="filter" aria-label="Find a file" placeholder="Find a scene or model" value=${wanted} onInput=${(e) => want(e.target.value)} />
    <ul class="files">${shown.map((f) => html`<li key=${f}><button type="button" onClick=${() => open(f)}>${f}</button></li>`)}</ul>
    ${files && shown.length === 0 && html`<p class="hint">No scene or model like that below the folder that sundog was started in.</p>`}
    <label class="button">Open a file of this computer<input type="file" accept=${['.json', ...store.state.models].join()} class="hidden" onChange=${(e) => {
      if (e.target.files[0]) openFile(e.target.files[0]);
      onClose();
    }} /></label>
  </${Dialog}>`;
}

export function CopyDialog({copyable}) {
  return html`<${Dialog} title=${copyable.what} onClose=${() => store.update({copyable: null})}>
    <p>The browser does not let the page copy by itself. Select the text and copy it:</p>
    <textarea class="copyable" readonly rows="6" aria-label=${copyable.what} onFocus=${(e) => e.target.select()}>${copyable.text}</textarea></${Dialog}>`;
}

export function SaveMenu() {
  const [open, setOpen] = useState(false);
  const items = [['Scene (.json)', saveScene], ['Picture (.png)', () => savePicture('png')], ['Picture (.exr)', () => savePicture('exr')],
    ['Copy the command line', copyCommand], ['Copy a link to this state', copyLink]];
  return html`<div class="menu" onKeyDown=${(e) => e.key === 'Escape' && setOpen(false)} onFocusOut=${(e) => !e.currentTarget.contains(e.relatedTarget) && setOpen(false)}>
    <button type="button" class="button" aria-haspopup="menu" aria-expanded=${open} onClick=${() => setOpen(!open)}>Save</button>
    ${open && html`<ul role="menu">${items.map(([name, act]) => html`<li role="none"><button type="button" role="menuitem" onClick=${() => {
      setOpen(false);
      act();
    }}>${name}</button></li>`)}</ul>`}
  </div>`;
}
