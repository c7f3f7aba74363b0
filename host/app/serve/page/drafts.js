// Texts typed into editors, by their pointers in the document. A text belongs to its editor until the document has it; only then may
// another text replace it. Each pause in typing sends the text as a separate undo step.
import {equal, get, leadsToSame} from './pointer.js';

const pause = 500;  // milliseconds

/** A value's lines as text; a blank line is a space in the document, where lines are never empty. */
export const textOf = (value) => (Array.isArray(value) ? value.map((line) => line.trimEnd()).join('\n') : value ?? '');
export function valueOf(text) {
  const lines = text.trimEnd().split('\n').map((line) => line.trimEnd() || ' ');
  if (!text.trim()) return undefined;
  return lines.length > 1 ? lines : lines[0];
}

export class Drafts {
  all = new Map();  // pointer → {text, timer, accepted, error}

  constructor(store) {
    this.store = store;
  }
  text(at) {
    return this.all.get(at)?.text ?? textOf(get(this.store.state.document, at));
  }
  error(at) {
    return this.all.get(at)?.error ?? null;
  }
  /** Whether the text differs from the document as the page shows it. */
  differs(at) {
    const draft = this.all.get(at);
    return !!draft && !equal(valueOf(draft.text), get(this.store.state.document, at));
  }

  write(at, text) {
    clearTimeout(this.all.get(at)?.timer);
    this.all.set(at, {text, timer: setTimeout(() => this.send(at), pause), accepted: false, error: null});
    this.store.update({});
  }
  send(at) {
    const draft = this.all.get(at);
    if (!draft?.timer) return;
    clearTimeout(draft.timer);
    draft.timer = null;
    if (this.differs(at)) this.store.set(at, valueOf(draft.text));
    else draft.accepted = true;
  }
  sendAll() {
    for (const at of this.all.keys()) this.send(at);
  }
  /** Drops the text in favour of the document's. */
  drop(at) {
    clearTimeout(this.all.get(at)?.timer);
    this.all.delete(at);
    this.store.update({});
  }
  forget() {
    for (const at of [...this.all.keys()]) this.drop(at);
  }
  /** The pointer of the newest text that the server refused. */
  refused() {
    return [...this.all.keys()].findLast((at) => this.all.get(at).error && this.differs(at));
  }
  refuse(changes, error) {
    for (const {at} of changes) if (this.all.has(at) && this.differs(at)) Object.assign(this.all.get(at), {error, accepted: false});
  }

  /** Call after a server's answer: accepts a text that the document now has; drops one that it no longer has (undo). */
  settle(before, document) {
    for (const [at, draft] of this.all) {
      const has = equal(valueOf(draft.text), get(document, at));
      if (has) Object.assign(draft, {accepted: true, error: null});
      else if (draft.accepted || !leadsToSame(before, document, at)) this.drop(at);
    }
  }
}
