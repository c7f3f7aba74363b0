// The camera's mathematics: vectors are arrays of three numbers, angles are degrees.
export const add = (a, b) => a.map((v, i) => v + b[i]);
export const sub = (a, b) => a.map((v, i) => v - b[i]);
export const scale = (a, s) => a.map((v) => v * s);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(...a);
export const unit = (a) => scale(a, 1 / (length(a) || 1));

/** Rotates a vector about an axis by Rodrigues' formula. */
export function turn(v, axis, degrees) {
  const k = unit(axis), t = (degrees * Math.PI) / 180, c = Math.cos(t), s = Math.sin(t);
  return add(add(scale(v, c), scale(cross(k, v), s)), scale(k, dot(k, v) * (1 - c)));
}

/** The unit vectors right, up and forward of a view. */
export function frame({position, target, up}) {
  const forward = unit(sub(target, position));
  const right = unit(cross(forward, up));
  return {forward, right, up: cross(right, forward)};
}

const tidy = (v) => v.map((x) => Number(x.toPrecision(9)));
export const withView = (camera, position, target) => ({...camera, position: tidy(position), target: tidy(target)});

/** Orbits about the target: `across` turns about "up", `along` tilts, but never over the pole. */
export function orbit(camera, across, along) {
  const away = sub(camera.position, camera.target);
  let next = turn(away, camera.up, across);
  const right = cross(unit(scale(next, -1)), unit(camera.up));
  const tilted = turn(next, right, along);
  if (Math.abs(dot(unit(tilted), unit(camera.up))) < 0.999) next = tilted;
  return withView(camera, add(camera.target, next), camera.target);
}

/** Turns the camera about its own position. */
export function look(camera, across, along) {
  const way = sub(camera.target, camera.position);
  let next = turn(way, camera.up, across);
  const tilted = turn(next, cross(unit(next), unit(camera.up)), along);
  if (Math.abs(dot(unit(tilted), unit(camera.up))) < 0.999) next = tilted;
  return withView(camera, camera.position, add(camera.position, next));
}

export const move = (camera, by) => withView(camera, add(camera.position, by), add(camera.target, by));

/** Moves right, up and forward, by fractions of the distance to the target. */
export function fly(camera, right, up, forward) {
  const f = frame(camera), d = length(sub(camera.target, camera.position));
  return move(camera, add(add(scale(f.right, right * d), scale(f.up, up * d)), scale(f.forward, forward * d)));
}

export function dolly(camera, factor) {
  const away = scale(sub(camera.position, camera.target), factor);
  const next = {...camera, orthographic: camera.orthographic * factor};  // the picture's height in the world; 0: perspective
  return length(away) > 1e-9 && length(away) < 1e12 ? withView(next, add(camera.target, away), camera.target) : camera;
}

/** The camera, turned about an axis through its target or its own position. */
export function turnAbout(camera, axis, degrees, about) {
  if (about === 'target')
    return {...withView(camera, add(camera.target, turn(sub(camera.position, camera.target), axis, degrees)), camera.target),
            up: tidy(turn(camera.up, axis, degrees))};
  return {...withView(camera, camera.position, add(camera.position, turn(sub(camera.target, camera.position), axis, degrees))),
          up: tidy(turn(camera.up, axis, degrees))};
}

/** A pixel's width in world units at this depth. */
const pixelAt = (camera, height, depth) =>
  camera.orthographic > 0 ? camera.orthographic / height : (2 * depth * Math.tan((camera.fov * Math.PI) / 360)) / height;

/** A point's position in a picture of this size: {x, y, depth}; null behind the camera. */
export function project(camera, width, height, point) {
  const f = frame(camera), d = sub(point, camera.position), depth = dot(d, f.forward);
  if (depth <= 1e-9) return null;
  const pixel = pixelAt(camera, height, depth);
  return {x: width / 2 + dot(d, f.right) / pixel, y: height / 2 - dot(d, f.up) / pixel, depth};
}

/** The displacement in the world for a displacement in the picture, at this depth. */
export function unproject(camera, height, dx, dy, depth) {
  const f = frame(camera), pixel = pixelAt(camera, height, depth);
  return add(scale(f.right, dx * pixel), scale(f.up, -dy * pixel));
}

/** The changes that set the document's camera to `camera`. */
export function cameraChanges(camera, before) {
  const changes = [{at: '/camera/position', value: camera.position}, {at: '/camera/target', value: camera.target}];
  if (camera.up.some((v, i) => v !== before.up[i])) changes.push({at: '/camera/up', value: camera.up});
  if (camera.orthographic !== before.orthographic) changes.push({at: '/camera/orthographic', value: camera.orthographic});
  return changes;
}
