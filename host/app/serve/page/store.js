// What the page knows: the document as the server and the person have it, what the server said of it, and what is selected.
// Changes are drawn here at once and sent one message at a time, the newest of a drag taking the place of those that wait.
import {apply} from './pointer.js';
import {Link} from './link.js';

class Store {
  state = {
    connected: 'connecting', client: 0, document: null, opened: null, file: '', version: 0, canUndo: false, canRedo: false,
    resolved: null, status: null, devices: [], options: {split: 'dynamic', work_group: 'auto', coarse: true},
    schema: null, formulas: [], functions: [], selection: null, picked: null, error: null, picture: null, tab: 'build', notice: '',
  };
  listeners = new Set();
  pending = [];
  inFlight = null;
  lastId = 0;
  asked = new Map();
  rates = [];

  listen(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
  update(patch) {
    Object.assign(this.state, patch);
    for (const listener of this.listeners) listener();
  }

  start() {
    this.link = new Link({
      open: () => {
        this.comesBack = this.state.document !== null;
        this.update({connected: 'yes'});
      },
      closed: (why) => {
        this.inFlight = null;
        this.update({connected: why});
      },
      message: (message) => this.take(message),
      picture: (header, blob) => this.onPicture?.(header, blob),
    });
    this.link.start();
    this.load();
  }
  async load() {
    try {
      const [schema, formulas] = await Promise.all(['schema', 'formulas'].map((name) => this.link.json(name)));
      this.update({schema, formulas: formulas.formulas, functions: formulas.functions});
    } catch (error) {
      this.update({connected: error.status === 401 ? 'token' : this.state.connected});
      if (error.status !== 401) setTimeout(() => this.load(), 1500);
    }
  }

  /** Changes the document, here and at the server. Changes of one gesture are undone together. */
  edit(changes, gesture = '') {
    let document = this.state.document;
    for (const change of changes) document = apply(document, change);
    this.update({document, error: null});
    for (const change of changes) {
      const last = this.pending[this.pending.length - 1];
      const same = last && gesture && this.pending.find((p) => p.gesture === gesture && p.change.at === change.at && 'value' in p.change);
      if (same && 'value' in change) same.change = change;
      else this.pending.push({change, gesture});
    }
    this.flush();
  }
  set(at, value, gesture = '') {
    this.edit([value === undefined ? {at} : {at, value}], gesture);
  }
  flush() {
    if (this.inFlight || this.pending.length === 0 || this.state.connected !== 'yes') return;
    const gesture = this.pending[0].gesture;
    const count = this.pending.findIndex((p) => p.gesture !== gesture);
    const taken = this.pending.splice(0, count < 0 ? this.pending.length : count);
    this.inFlight = ++this.lastId;
    this.link.send({do: 'edit', id: this.inFlight, gesture, changes: taken.map((p) => p.change)});
  }

  /** Asks for what a pixel shows. */
  pick(x, y) {
    const id = ++this.lastId;
    this.link.send({do: 'pick', id, x, y});
    return new Promise((resolve) => this.asked.set(id, resolve));
  }
  say(what, more = {}) {
    this.link.send({do: what, ...more});
  }
  notice(text) {
    this.update({notice: text});
    clearTimeout(this.noticeTimer);
    this.noticeTimer = setTimeout(() => this.update({notice: ''}), 5000);
  }

  take(message) {
    const takers = {
      welcome: () => this.update({client: message.client}),
      devices: () => this.update({devices: message.devices}),
      options: () => this.update({options: message}),
      scene: () => this.takeScene(message),
      changed: () => this.takeChanged(message),
      refused: () => this.takeRefused(message),
      status: () => this.takeStatus(message),
      picked: () => {
        this.asked.get(message.id)?.(message);
        this.asked.delete(message.id);
      },
    };
    takers[message.is]?.();
  }
  /** A server that was started anew has the scene's file again: it gets back what this page shows. */
  async giveBack(message) {
    if (!this.comesBack) return false;
    this.comesBack = false;
    const mine = this.state.document, name = this.state.file;
    if (message.version >= this.state.version || message.file !== name || JSON.stringify(mine) === JSON.stringify(message.document)) return false;
    await this.link.call('scene?name=' + encodeURIComponent(name), {method: 'POST', body: JSON.stringify(mine)});
    this.notice('The server was started anew; the scene is as you left it.');
    return true;
  }
  async takeScene(message) {
    if (await this.giveBack(message).catch(() => false)) return;
    if (message.version !== this.state.version) this.update({error: null});
    this.update({
      document: message.document, opened: message.opened, file: message.file, version: message.version,
      canUndo: message.can_undo, canRedo: message.can_redo, resolved: message.resolved,
    });
    if (this.inFlight === null) this.flush();
  }
  takeChanged(message) {
    const own = message.client === this.state.client;
    if (own && message.id === this.inFlight) this.inFlight = null;
    let document = this.state.document;
    if (!own || this.pending.length === 0)
      for (const change of message.changes) document = apply(document, change);
    this.update({document, version: message.version, canUndo: message.can_undo, canRedo: message.can_redo, resolved: message.resolved});
    this.flush();
  }
  takeRefused(message) {
    if (message.id !== undefined && message.id === this.inFlight) {
      this.inFlight = null;
      this.pending = [];
      this.say('scene');
    }
    this.update({error: {at: message.at ?? '', reason: message.reason}});
  }
  takeStatus(status) {
    const total = status.rays.primary + status.rays.reflection + status.rays.refraction + status.rays.shadow;
    const before = this.state.status;
    const now = performance.now();
    if (before && before.shown === status.shown && total > before.total) {
      this.rates.push({at: now, rate: (total - before.total) / Math.max(1e-3, (now - before.at) / 1000)});
    } else if (before?.shown !== status.shown && total > 0) {
      this.rates.push({at: now, rate: total / Math.max(1e-3, status.seconds)});
    }
    if (this.rates.length > 120) this.rates.shift();
    this.update({status: {...status, total, at: now}});
  }
}

export const store = new Store();
