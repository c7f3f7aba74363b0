// The page: the bar at the top, the picture, the panels beside it, and the status line below.
import {html, render, Button, useEffect, useState, useStore, short, seconds} from './ui.js';
import {store} from './store.js';
import {View} from './view.js';
import {BuildPanel} from './panels/build.js';
import {CameraPanel} from './panels/camera.js';
import {LightPanel} from './panels/light.js';
import {ImagePanel} from './panels/image.js';
import {DevicesPanel} from './panels/devices.js';
import {StatisticsPanel} from './panels/statistics.js';
import {CopyDialog, OpenDialog, QuestionDialog, SaveMenu, openFile, openLink} from './files.js';

const tabs = [['build', 'Build', BuildPanel], ['camera', 'Camera', CameraPanel], ['light', 'Light', LightPanel], ['image', 'Image', ImagePanel],
  ['devices', 'Devices', DevicesPanel], ['statistics', 'Statistics', StatisticsPanel]];

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  try {
    localStorage.setItem('sundog-theme', theme);
  } catch {
    // without storage, the theme still changes for now
  }
}
function nextTheme() {
  const dark = (document.documentElement.dataset.theme || (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark')) === 'dark';
  setTheme(dark ? 'light' : 'dark');
}

function Bar() {
  const file = useStore(store, (s) => s.file);
  const canUndo = useStore(store, (s) => s.canUndo), canRedo = useStore(store, (s) => s.canRedo);
  const changed = useStore(store, () => store.unsaved);
  const [opening, open] = useState(false);
  return html`<header class="bar">
    <h1><img src="/sundog.svg" alt="" width="20" height="20" />sundog</h1>
    <span class="file" title=${file}>${file}${changed ? ' •' : ''}</span>
    <${Button} label="Open" onClick=${() => open(true)} />
    <${SaveMenu} />
    <span class="gap"></span>
    <${Button} label="Undo" title="Undo (Ctrl+Z)" disabled=${!canUndo} onClick=${() => store.undo()} />
    <${Button} label="Redo" title="Redo (Ctrl+Shift+Z)" disabled=${!canRedo} onClick=${() => store.redo()} />
    <${Button} label="◐" title="Dark or light" onClick=${nextTheme} />
    ${opening && html`<${OpenDialog} onClose=${() => open(false)} />`}
  </header>`;
}

function Panels() {
  const tab = useStore(store, (s) => s.tab);
  const ready = useStore(store, (s) => !!(s.schema && s.document && s.formulas.length));
  const Panel = tabs.find(([id]) => id === tab)[2];
  const key = (event) => {
    const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (!step) return;
    const next = tabs[(tabs.findIndex(([id]) => id === tab) + step + tabs.length) % tabs.length][0];
    store.update({tab: next});
    document.getElementById('tab-' + next).focus();
  };
  return html`<aside class="side" aria-label="Scene and settings">
    <div class="tabs" role="tablist" onKeyDown=${key}>${tabs.map(([id, name]) => html`<button type="button" role="tab" id=${'tab-' + id} aria-controls="panel" aria-selected=${id === tab}
      tabindex=${id === tab ? 0 : -1} onClick=${() => store.update({tab: id})}>${name}</button>`)}</div>
    <div class="panel" id="panel" role="tabpanel" aria-labelledby=${'tab-' + tab} tabindex="-1">${ready && html`<${Panel} />`}</div>
  </aside>`;
}

const words = {connecting: 'connecting…', no: 'no server: it is asked again…', refused: 'cannot connect: it is tried again…', token: 'the token is wrong: open the URL that sundog has printed'};

function StatusLine() {
  const status = useStore(store, (s) => s.status), connected = useStore(store, (s) => s.connected);
  const refusal = useStore(store, (s) => s.refusal);
  const picture = useStore(store, (s) => s.picture);
  const [now, tick] = useState(0);
  const busy = status && !status.settled && !status.failed && status.state > 0 && status.state < 4;
  useEffect(() => {
    if (!busy) return;
    const timer = setInterval(() => tick((n) => n + 1), 500);
    return () => clearInterval(timer);
  }, [busy, status?.generation]);
  const [began, setBegan] = useState({generation: 0, at: 0});
  if (status && began.generation !== status.generation) setBegan({generation: status.generation, at: performance.now()});
  const waited = (performance.now() - began.at) / 1000;
  const text = connected !== 'yes' ? words[refusal ? 'refused' : connected] : !status ? 'starting' : status.failed ? 'failed: ' + status.error
    : status.settled ? `finished in ${seconds(status.seconds)}` : status.text + (busy && waited > 0.7 ? `, ${Math.round(waited)} s` : '');
  const rate = store.rates.length ? store.rates[store.rates.length - 1].rate : 0;
  return html`<footer class="status" data-state=${connected !== 'yes' ? connected : status?.settled ? 'settled' : status?.failed ? 'failed' : 'busy'} data-generation=${status?.generation}>
    <span class="lamp" aria-hidden="true"></span><span class="doing" role="status">${text}</span>
    <progress max="1" value=${status?.settled ? 1 : status?.fraction ?? 0} aria-label="Progress"></progress>
    <span>${picture ? `${picture.width}×${picture.height}` : ''}${picture && picture.block > 1 ? `, 1/${picture.block} of the resolution` : ''}</span>
    <span>${status ? `${status.samples}/${status.wanted_samples} samples` : ''}</span>
    <span class="rate">${short(rate)} rays/s</span>
  </footer>`;
}

function Notices() {
  const refusal = useStore(store, (s) => s.refusal), error = useStore(store, (s) => s.error), notice = useStore(store, (s) => s.notice);
  const copyable = useStore(store, (s) => s.copyable), question = useStore(store, (s) => s.question);
  return html`<div class="notices">
    ${refusal && html`<p class="toast bad" role="alert">Cannot connect: ${refusal}</p>`}
    ${error && html`<p class="toast bad" role="alert"><span>${error.at ? error.at + ': ' : ''}${error.reason}</span><${Button} kind="small" label="✕" title="Dismiss" onClick=${() => store.update({error: null})} /></p>`}
    ${notice && html`<p class="toast" role="status">${notice}</p>`}
    ${copyable && html`<${CopyDialog} copyable=${copyable} />`}
    ${question && html`<${QuestionDialog} answer=${question} />`}</div>`;
}

function keyboard(event) {
  const key = event.key.toLowerCase();
  if (event.defaultPrevented || !(event.ctrlKey || event.metaKey) || (key !== 'z' && key !== 'y')) return;
  if (event.target.matches('input[type=text], input[type=search], textarea') || document.querySelector('dialog')) return;
  event.preventDefault();
  if (key === 'y' || event.shiftKey) store.redo();
  else store.undo();
}

function App() {
  useEffect(() => {
    document.addEventListener('keydown', keyboard);
    document.addEventListener('dragover', (event) => event.preventDefault());
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      if (event.dataTransfer.files[0]) openFile(event.dataTransfer.files[0]);
    });
  }, []);
  return html`<${Bar} /><${View} /><${Panels} /><${StatusLine} /><${Notices} />`;
}

try {
  const theme = localStorage.getItem('sundog-theme');
  if (theme) document.documentElement.dataset.theme = theme;
} catch {
  // without storage, use the system's theme
}
const root = document.getElementById('app');
root.replaceChildren();
render(html`<${App} />`, root);
store.start();
addEventListener('hashchange', () => {
  store.takeToken();
  openLink();
});
openLink();
