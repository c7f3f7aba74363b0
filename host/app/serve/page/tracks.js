// Computes the value of a track with keys at a frame, like host/scene/read/tracks.cpp.

/** The slope of component c at a key: Catmull-Rom, limited to avoid overshooting; 0 at the ends unless the track is a cycle. */
function slopeAt({keys, cycle}, i, c) {
  const last = keys.length - 1, end = i === 0 || i === last;
  if (end && (!cycle || last === 0)) return 0;
  const length = (k) => keys[k + 1].frame - keys[k].frame;
  const secant = (k) => (keys[k + 1].value[c] - keys[k].value[c]) / length(k);
  const before = i === 0 ? last - 1 : i - 1, after = i === last ? 0 : i;
  const a = secant(before), b = secant(after);
  if (a * b <= 0) return 0;
  const mean = (a * length(before) + b * length(after)) / (length(before) + length(after));
  return Math.sign(mean) * Math.min(Math.abs(mean), 3 * Math.min(Math.abs(a), Math.abs(b)));
}

const bezier = ([a, b, c, d], s) => (1 - s) ** 3 * a + 3 * (1 - s) ** 2 * s * b + 3 * (1 - s) * s * s * c + s ** 3 * d;

/** The parameter, 0 to 1, at which a Bezier curve with rising frames passes `frame`. */
function placeOf(frames, frame) {
  let low = 0, high = 1;
  for (let i = 0; i < 60; ++i) {
    const middle = (low + high) / 2;
    if (bezier(frames, middle) < frame) low = middle;
    else high = middle;
  }
  return (low + high) / 2;
}

/** The track's value at a frame, an array of numbers. */
export function valueAt(track, frame) {
  const {keys, type, cycle} = track, first = keys[0].frame, last = keys[keys.length - 1].frame;
  if (cycle && last > first) frame -= Math.floor((frame - first) / (last - first)) * (last - first);
  const after = keys.findIndex((key) => key.frame > frame);
  if (after === 0) return keys[0].value;
  const i = (after < 0 ? keys.length : after) - 1, from = keys[i], to = keys[i + 1];
  if (!to || type === 'step') return from.value;
  const third = (to.frame - from.frame) / 3, free = type === 'bezier';
  const right = free && from.handle_right, left = free && to.handle_left;
  const frames = [from.frame, right ? right.frame : from.frame + third, left ? left.frame : to.frame - third, to.frame];
  const s = placeOf(frames, frame);
  return from.value.map((a, c) => {
    const b = to.value[c];
    if (type === 'linear') return a + ((b - a) * (frame - from.frame)) / (to.frame - from.frame);
    return bezier([a, right ? right.value[c] : a + third * slopeAt(track, i, c), left ? left.value[c] : b - third * slopeAt(track, i + 1, c), b], s);
  });
}
