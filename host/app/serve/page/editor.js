// The editor of formulas: CodeMirror with the formula language's words, in a shadow root, where it may add its own style sheets (the page's
// policy forbids style elements).
import {html, useEffect, useRef, useStore} from './ui.js';
import {store} from './store.js';
import * as cm from './vendor/codemirror.module.js';

const pause = 400;  // milliseconds between two steps of the editor's own history; less than the pause that sends a text

/** Highlights numbers, names, functions of the language, and operators. */
const language = cm.StreamLanguage.define({
  token(stream) {
    if (stream.eatSpace()) return null;
    if (stream.match(/^(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?/)) return 'number';
    if (stream.match(/^\/\/.*/)) return 'comment';
    if (stream.match(/^[A-Za-z_]\w*(?=\s*\()/)) return 'keyword';
    if (stream.match(/^[A-Za-z_]\w*/)) return 'variableName';
    stream.next();
    return 'operator';
  },
});

const colors = cm.HighlightStyle.define([
  {tag: cm.tags.number, color: 'var(--code-number)'},
  {tag: cm.tags.keyword, color: 'var(--code-function)'},
  {tag: cm.tags.comment, color: 'var(--soft)'},
]);

const look = cm.EditorView.theme({
  '&': {font: '12px/1.45 ui-monospace, "DejaVu Sans Mono", monospace', color: 'var(--text)', backgroundColor: 'var(--raised)'},
  '&.cm-focused': {outline: '2px solid var(--accent)', outlineOffset: '-1px'},
  '.cm-content': {caretColor: 'var(--text)', padding: '4px 0', minHeight: '22px'},
  '.cm-cursor': {borderLeftColor: 'var(--text)'},
  '.cm-gutters': {backgroundColor: 'transparent', color: 'var(--soft)', border: '0'},
  '.cm-scroller': {fontFamily: 'inherit', lineHeight: 'inherit'},
  '&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground': {backgroundColor: 'var(--selected)'},
  '.cm-matchingBracket': {backgroundColor: 'var(--selected)', outline: '0'},
  '.cm-tooltip': {backgroundColor: 'var(--panel)', color: 'var(--text)', border: '1px solid var(--line)', borderRadius: '5px'},
  '.cm-tooltip-autocomplete > ul > li[aria-selected]': {backgroundColor: 'var(--selected)', color: 'var(--text)'},
  '.cm-lintRange-error': {backgroundImage: 'none', textDecoration: 'underline wavy var(--bad)', backgroundColor: 'var(--bad-back)'},
});

/** Completes functions of the language, and the parameters and variables in `extra`. */
function completions(extra) {
  return (context) => {
    const word = context.matchBefore(/[A-Za-z_]\w*/);
    if (!word && !context.explicit) return null;
    const functions = store.state.functions.map((f) => ({label: f.call.replace(/\(.*/, ''), detail: f.call.replace(/^[^(]*/, ''), info: f.meaning, type: 'function'}));
    return {from: word ? word.from : context.pos, options: [...functions, ...extra.current.map((label) => ({label, type: 'variable'}))]};
  };
}

const historyCommand = (key) => cm.historyKeymap.find((binding) => binding.key === key).run;
const undoTyping = historyCommand('Mod-z'), redoTyping = historyCommand('Mod-y');

/** Undo takes back typing that the document does not have yet; otherwise it is the page's undo. */
function keymap(at) {
  const undo = (view) => (store.drafts.differs(at) && undoTyping(view)) || (store.undo(), true);
  const redo = (view) => redoTyping(view) || (store.redo(), true);
  return cm.keymap.of([{key: 'Mod-z', run: undo}, {key: 'Mod-y', run: redo}, {key: 'Mod-Shift-z', run: redo},
    ...cm.closeBracketsKeymap, ...cm.completionKeymap, ...cm.defaultKeymap]);
}

function stateOf(doc, {at, label, words}) {
  return cm.EditorState.create({
    doc,
    extensions: [
      keymap(at), cm.history({newGroupDelay: pause}), cm.lineNumbers(), cm.drawSelection(), cm.bracketMatching(), cm.closeBrackets(), language, cm.syntaxHighlighting(colors), look,
      // Enter starts a new line unless an entry of the list is selected.
      cm.autocompletion({override: [completions(words)], icons: false, selectOnOpen: false}),
      cm.EditorView.lineWrapping,
      cm.EditorView.contentAttributes.of({'aria-label': label, spellcheck: 'false', autocapitalize: 'off'}),
      cm.EditorView.updateListener.of((update) => {
        if (update.docChanged) store.drafts.write(at, update.state.doc.toString());
        if (update.focusChanged && !update.view.hasFocus) store.drafts.send(at);
      }),
    ],
  });
}

/** Edits the text at `at`. `place`: {line, column, reason} of an error, counted from 1, or null. */
export function CodeEditor({id, at, label, words, place}) {
  const host = useRef(), view = useRef(), known = useRef([]);
  known.current = words ?? [];
  useEffect(() => {
    const root = host.current.shadowRoot ?? host.current.attachShadow({mode: 'open'});
    view.current = new cm.EditorView({root, parent: root, state: stateOf(store.drafts.text(at), {at, label, words: known})});
    host.current.editor = view.current;
    return () => view.current.destroy();
  }, []);
  const text = useStore(store, () => store.drafts.text(at));
  useEffect(() => {
    // The current text, not the rendered one: the user may have typed more.
    const wanted = store.drafts.text(at), {doc, selection} = view.current.state;
    if (doc.toString() === wanted) return;
    view.current.setState(stateOf(wanted, {at, label, words: known}));
    view.current.dispatch({selection: {anchor: Math.min(selection.main.head, wanted.length)}});
  }, [text]);
  useEffect(() => {
    const doc = view.current.state.doc, list = [];
    if (place && place.line <= doc.lines) {
      const line = doc.line(place.line), from = Math.min(line.from + place.column - 1, Math.max(line.from, line.to - 1));
      const word = /^\w+/.exec(doc.sliceString(from, line.to));
      list.push({from, to: Math.min(line.to, from + (word ? word[0].length : 1)), severity: 'error', message: place.reason});
    }
    view.current.dispatch(cm.setDiagnostics(view.current.state, list));
  }, [place?.line, place?.column, place?.reason]);
  return html`<div ref=${host} id=${id} class=${'code' + (place ? ' bad' : '')} data-code=${label}></div>`;
}
