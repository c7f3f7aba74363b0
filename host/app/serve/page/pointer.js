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

function changed(value, keys, next) {
  if (keys.length === 0) return next;
  const [key, ...rest] = keys;
  const copy = Array.isArray(value) ? value.slice() : {...(value ?? {})};
  const index = Array.isArray(copy) && key === '-' ? copy.length : key;
  if (rest.length === 0 && next === undefined) {
    if (Array.isArray(copy)) copy.splice(Number(index), 1);
    else delete copy[index];
  } else {
    copy[index] = changed(copy[index], rest, next);
  }
  return copy;
}

/** The document with one change: {at, value}, or {at} alone to take it out. */
export function apply(document, change) {
  if (!('value' in change) && get(document, change.at) === undefined) return document;
  return changed(document, parts(change.at), change.value);
}
