// The page's state: the server's document with the user's edits, the server's answers, and the selection.
// Changes are shown at once and sent one message at a time (edits.js); texts belong to their editors meanwhile (drafts.js).
import {Drafts} from './drafts.js';
import {Edits} from './edits.js';
import {apply, equal} from './pointer.js';
import {Link, tokenOfAddress} from './link.js';

class Store {
  state = {
    connected: 'connecting', refusal: '', client: 0, document: null, opened: null, file: '', version: 0, canUndo: false, canRedo: false,
    resolved: null, status: null, devices: [], options: {split: 'dynamic', work_group: 'auto', coarse: true}, lights: [],
    schema: null, formulas: [], functions: [], selection: null, picked: null, error: null, picture: null, tab: 'build', notice: '',
    mostUpload: Infinity, models: [],  // models: file extensions
    question: null, since: null, scenes: 0,  // since: the version that was opened; scenes: whole documents received
  };
  listeners = new Set();
  edits = new Edits();
  drafts = new Drafts(this);
  lastId = 0;
  asked = new Map();
  rates = [];

  listen(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
  /** Waits until the state passes `test`. */
  until(test) {
    return new Promise((resolve) => {
      const stop = this.listen(() => {
        if (!test(this.state)) return;
        stop();
        resolve();
      });
      this.update({});
    });
  }
  update(patch) {
    Object.assign(this.state, patch);
    for (const listener of this.listeners) listener();
  }

  start() {
    this.link = new Link({
      open: () => {
        this.comesBack = this.state.document !== null;
        this.update({connected: 'yes', refusal: ''});
      },
      closed: (why) => {
        this.edits.sent = null;  // the document shows whether the server has it, once it is back
        this.update({connected: why, refusal: why === 'token' ? '' : this.state.refusal});
      },
      refused: (refusal) => this.update({refusal}),
      message: (message) => this.take(message),
      picture: (header, blob) => this.onPicture?.(header, blob),
    });
    this.link.start();
    this.load();
  }
  /** Takes the token of a new address, which does not reload the page in this tab, unless the old token still works. */
  takeToken() {
    if (this.state.connected === 'yes') return;
    this.link.token = tokenOfAddress();
    if (this.state.connected !== 'token') return;
    this.update({connected: 'connecting'});
    this.link.start();
    if (!this.state.schema) this.load();
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
    this.edits.add(changes, gesture);
    this.update({document: changes.reduce(apply, this.state.document), error: null});
    this.flush();
  }
  set(at, value, gesture = '') {
    this.edit([value === undefined ? {at} : {at, value}], gesture);
  }
  flush() {
    if (this.state.connected !== 'yes') return;
    const message = this.edits.next(++this.lastId);
    if (message) this.link.send(message);
  }
  /** Undoes the last step or, if a text was refused, drops that text. */
  undo() {
    this.drafts.sendAll();
    const refused = this.edits.idle && this.drafts.refused();
    if (refused) this.drafts.drop(refused);
    else this.step('undo');
  }
  redo() {
    this.drafts.sendAll();
    this.step('redo');
  }
  step(step) {
    this.edits.addStep(step);
    this.flush();
  }
  /** Whether the document has unsaved edits; compared once for each document. */
  get unsaved() {
    const {document, opened} = this.state, {compared, saved} = this;
    if (compared?.document !== document || compared.opened !== opened || compared.saved !== saved)
      this.compared = {document, opened, saved, differs: document !== null && !equal(document, opened) && !equal(document, saved)};
    return this.compared.differs;
  }

  /** Asks the server which object a pixel shows. */
  pick(x, y) {
    const id = ++this.lastId;
    this.link.send({do: 'pick', id, x, y});
    return new Promise((resolve) => this.asked.set(id, resolve));
  }
  say(what, more = {}) {
    this.link.send({do: what, ...more});
  }
  /** Sets the balance of light groups, as for `sundog mix --light`. */
  balance(lights) {
    this.update({lights});
    this.say('balance', {lights});
  }
  notice(text) {
    this.update({notice: text});
    clearTimeout(this.noticeTimer);
    this.noticeTimer = setTimeout(() => this.update({notice: ''}), 5000);
  }

  take(message) {
    const takers = {
      welcome: () => {
        for (const id of [...this.asked.keys()]) this.takePicked({id, object: null});  // asked of a lost connection
        this.update({client: message.client, mostUpload: message.most_upload_bytes, models: message.models.split(' ')});
      },
      devices: () => this.update({devices: message.devices}),
      options: () => this.update({options: message}),
      balance: () => message.client !== this.state.client && this.update({lights: message.lights}),
      scene: () => this.takeScene(message),
      changed: () => this.takeChanged(message),
      refused: () => this.takeRefused(message),
      status: () => this.takeStatus(message),
      picked: () => this.takePicked(message),
    };
    takers[message.is]?.();
  }
  /** Sends this page's document to a restarted server, which has opened the scene's file again. Returns whether it did. */
  async giveBack(message) {
    if (!this.comesBack) return false;
    this.comesBack = false;
    const mine = this.state.document, name = this.state.file;
    if (message.version >= this.state.version || message.file !== name || equal(mine, message.document)) return false;
    await this.link.call('scene?name=' + encodeURIComponent(name), {method: 'POST', body: JSON.stringify(mine)});
    this.edits.forget();
    this.notice('The server was started anew; the scene is as you left it.');
    return true;
  }
  async takeScene(message) {
    if (await this.giveBack(message).catch(() => false)) return;
    const another = message.since !== this.state.since, before = this.edits.confirmed;
    if (another && this.state.since !== null) this.edits.forget();
    if (another) this.drafts.forget();
    this.edits.takeAll(message.document, message.client === this.state.client && message.id === this.edits.sent?.id);
    if (message.version !== this.state.version) this.update({error: null});
    this.shows(before, message, {opened: message.opened, file: message.file, since: message.since, scenes: this.state.scenes + 1});
  }
  takeChanged(message) {
    const own = message.client === this.state.client && message.id === this.edits.sent?.id, before = this.edits.confirmed;
    this.edits.take(message.changes, own);
    this.shows(before, message);
  }
  takePicked(picked) {
    this.asked.get(picked.id)?.(picked);
    this.asked.delete(picked.id);
  }
  takeRefused(message) {
    if (this.asked.has(message.id)) return this.takePicked({id: message.id, object: null, error: message.reason});
    const error = {at: message.at ?? '', reason: message.reason};
    if (message.id !== undefined && message.id === this.edits.sent?.id) {
      const {changes = []} = this.edits.refuse(), undone = this.edits.waiting[0]?.step === 'undo';
      if (undone) this.edits.waiting.shift();  // it meant the refused edit
      this.shows(this.edits.confirmed);
      this.drafts.refuse(changes, error);
      if (undone) for (const {at} of changes) this.drafts.drop(at);
    }
    this.update({error});
  }
  /** Shows the document after a server's answer; `message` has further values. A camera that the user is moving stays. */
  shows(before, message, more = {}) {
    if (message) this.told = message.resolved;
    const moving = this.edits.concern('/camera') && this.state.resolved;
    this.update({
      document: this.edits.shown(), resolved: moving ? {...this.told, camera: this.state.resolved.camera} : this.told, ...more,
      ...(message && {version: message.version, canUndo: message.can_undo, canRedo: message.can_redo}),
    });
    this.drafts.settle(before, this.edits.confirmed);
    this.flush();
  }
  /** Takes a status. Computes rates by the server's clock, because messages may arrive late and several at once. */
  takeStatus(status) {
    const total = status.rays.primary + status.rays.reflection + status.rays.refraction + status.rays.shadow;
    const before = this.counted?.shown === status.shown ? this.counted : {total: 0, seconds: 0};
    const seconds = status.seconds - before.seconds;
    if (total > before.total && seconds > 0.05) {
      this.counted = {shown: status.shown, total, seconds: status.seconds};
      this.rates.push({rate: (total - before.total) / seconds});
    }
    if (this.rates.length > 120) this.rates.shift();
    this.update({status: {...status, total, at: performance.now()}});
  }
}

export const store = new Store();
