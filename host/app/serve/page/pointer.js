// JSON pointers (RFC 6901) into documents that are never changed in place.
export const join = (at, key) => at + '/' + String(key).replace(/~/g, '~0').replace(/\//g, '~1');
export const parts = (at) => at.split('/').slice(1).map((t) => t.replace(/~1/g, '/').replace(/~0/g, '~'));

export function get(document, at) {
  let value = document;
  for (const key of parts(at)) {
    if (value === null || typeof value !== 'object') return undefined;
    value = value[key];
  }
  return value;
}

function changedList(list, key, rest, next) {
  const copy = list.slice(), index = key === '-' ? copy.length : Number(key);
  if (rest.length === 0 && next === undefined) copy.splice(index, 1);
  else copy[index] = changed(copy[index], rest, next);
  return copy;
}

function changed(value, keys, next) {
  if (keys.length === 0) return next;
  const [key, ...rest] = keys;
  if (Array.isArray(value)) return changedList(value, key, rest, next);
  if (key === '-' && (value ?? null) === null) return changedList([], key, rest, next);  // the list is made with its first item
  const copy = {...value};
  if (rest.length === 0 && next === undefined) delete copy[key];
  else copy[key] = changed(copy[key], rest, next);
  return copy;
}

/** The document with one change: {at, value} sets a value, {at} alone removes it. */
export function apply(document, change) {
  if (!('value' in change) && get(document, change.at) === undefined) return document;
  return changed(document, parts(change.at), change.value);
}

/** Whether two documents are equal, whatever the order of keys. */
export function equal(a, b) {
  if (a === b) return true;
  if (a === null || b === null || typeof a !== 'object' || typeof b !== 'object' || Array.isArray(a) !== Array.isArray(b)) return false;
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => Object.hasOwn(b, key) && equal(a[key], b[key]));
}

/** Whether a pointer leads to the same thing in both documents, i.e. no list on the way has moved its items. */
export function leadsToSame(before, after, at) {
  let a = before, b = after;
  for (const key of parts(at)) {
    if (Array.isArray(a) !== Array.isArray(b)) return false;
    if (Array.isArray(a) && key !== '-' && a.length !== b.length && !equal(a[key], b[key])) return false;
    a = a?.[key];
    b = b?.[key];
  }
  return true;
}
