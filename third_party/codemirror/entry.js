// The exports of codemirror.module.js, which make.sh builds.
export {EditorView, keymap, lineNumbers, drawSelection, tooltips} from '@codemirror/view';
export {EditorState, Compartment, Annotation} from '@codemirror/state';
export {defaultKeymap, history, historyKeymap} from '@codemirror/commands';
export {StreamLanguage, HighlightStyle, syntaxHighlighting, bracketMatching} from '@codemirror/language';
export {tags} from '@lezer/highlight';
export {setDiagnostics} from '@codemirror/lint';
export {autocompletion, completionKeymap, closeBrackets, closeBracketsKeymap} from '@codemirror/autocomplete';
