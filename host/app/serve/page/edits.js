// The document between page and server: as the server has confirmed it, plus the page's own edits that are sent or waiting. The page shows
// the confirmed document with those edits applied, so that none is applied twice and none is lost.
import {apply, leadsToSame} from './pointer.js';

const most = 200;  // changes per message
const moves = (change) => !('value' in change) || change.at.endsWith('/-');
const touches = (a, b) => a === b || a.startsWith(b + '/') || b.startsWith(a + '/');

export class Edits {
  confirmed = null;
  sent = null;   // {id, changes}, or {id, step: 'undo'}
  waiting = [];  // {change, gesture}, or {step}
  count = 0;

  shown() {
    return [...(this.sent?.changes ?? []), ...this.waiting.flatMap((one) => one.change ?? [])].reduce(apply, this.confirmed);
  }
  /** Whether an edit of this place, or of a part of it, is not yet confirmed. */
  concern(at) {
    return [...(this.sent?.changes ?? []), ...this.waiting.flatMap((one) => one.change ?? [])].some((change) => touches(change.at, at));
  }
  get idle() {
    return this.sent === null && this.waiting.length === 0;
  }

  /** Adds changes. Changes of one gesture are undone together; a change replaces a waiting one of the same place. */
  add(changes, gesture) {
    const name = gesture || 'edit' + ++this.count;
    for (const change of changes) {
      const older = 'value' in change && this.older(change.at, name);
      if (older) older.change = change;
      else this.waiting.push({change, gesture: name});
    }
  }
  older(at, gesture) {
    for (const one of this.waiting.toReversed()) {
      if (one.step || one.gesture !== gesture) return null;
      if (one.change.at === at && !moves(one.change)) return one;
      if (moves(one.change) || touches(one.change.at, at)) return null;
    }
    return null;
  }
  addStep(step) {
    this.waiting.push({step});
  }

  /** The next message, or null. */
  next(id) {
    if (this.sent || this.waiting.length === 0) return null;
    const {step, gesture} = this.waiting[0];
    if (step) {
      this.waiting.shift();
      this.sent = {id, step};
      return {do: step, id};
    }
    const end = this.waiting.findIndex((one, i) => one.step || one.gesture !== gesture || i === most);
    const changes = this.waiting.splice(0, end < 0 ? this.waiting.length : end).map((one) => one.change);
    this.sent = {id, changes};
    return {do: 'edit', id, gesture, changes};
  }

  /** Applies changes that the server has made, from this page (`own`) or another. */
  take(changes, own) {
    const before = this.confirmed;
    this.confirmed = changes.reduce(apply, before);
    if (own) this.sent = null;
    else this.rebase(before);
  }
  /** Takes the server's whole document. `answers`: it is the result of this page's undo or redo. */
  takeAll(document, answers) {
    const before = this.confirmed;
    this.confirmed = document;
    if (answers) this.sent = null;
    this.rebase(before);
  }
  /** Removes and returns the sent edit, which the server refused. */
  refuse() {
    const sent = this.sent, before = (sent.changes ?? []).reduce(apply, this.confirmed);
    this.sent = null;
    this.rebase(before);
    return sent;
  }
  /** Drops waiting edits whose place in the document has changed. */
  rebase(before) {
    this.waiting = this.waiting.filter(({change}) => !change || leadsToSame(before, this.confirmed, change.at));
  }
  /** Drops edits that the server will not answer, or will send again. */
  forget() {
    this.sent = null;
    this.waiting = [];
  }
}
