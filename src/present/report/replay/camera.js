// Where the viewer is, and where a place of the world is on the screen.

const add = (a, b, k = 1) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
const scale = (a, k) => [k * a[0], k * a[1], k * a[2]];
const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => scale(a, 1 / (Math.hypot(...a) || 1));
const NEAR = 0.15;

// Box around everything that is shown.
const box = (() => {
  const low = [Infinity, Infinity, 0], high = [-Infinity, -Infinity, 1];
  const take = p => p.forEach((x, k) => { low[k] = Math.min(low[k], x); high[k] = Math.max(high[k], x); });
  if (track) track.gates.forEach(g => take(g.centre));
  vehicles.forEach(v => { for (let i = 0; i < v.time.length; i += 5) take(v.position.slice(3 * i, 3 * i + 3)); });
  return { low, high, middle: scale(add(low, high), 0.5), size: Math.hypot(high[0] - low[0], high[1] - low[1]) };
})();

const camera = {
  mode: "orbit", azimuth: -0.9, elevation: 0.42, distance: 14, pan: [0, 0, 0], topSpan: 1,
  eye: [0, 0, 0], right: [1, 0, 0], up: [0, 0, 1], ahead: [0, 1, 0], flat: false, focus: 1, width: 1, height: 1,
  heading: null,
};

function chooseCamera(mode) {
  camera.mode = mode;
  camera.pan = [0, 0, 0];
  camera.heading = null;
  if (mode === "orbit") Object.assign(camera, { distance: 14, elevation: 0.42 });
  if (mode === "follow") Object.assign(camera, { distance: 5.5 });
  if (mode === "top") camera.topSpan = 1;
  if (mode === "whole") Object.assign(camera, { distance: 0.9 * box.size + 4, elevation: 0.66, azimuth: -1.75 });
}

// Places the camera for the vehicle in view; seconds since the last picture smooth the following.
function aim(state, seconds) {
  const c = camera;
  c.flat = c.mode === "top";
  if (c.flat) {
    [c.right, c.up, c.ahead] = [[1, 0, 0], [0, 1, 0], [0, 0, -1]];
    // The panels at the sides and the bar below take room from the picture.
    const room = [Math.max(200, c.width - 620), c.height - 100];
    c.focus = Math.min(room[0] / (box.high[0] - box.low[0] + 6), room[1] / (box.high[1] - box.low[1] + 6)) * c.topSpan;
    c.eye = add([box.middle[0] + 12 / c.focus, box.middle[1] - 25 / c.focus, 100], c.pan);
    return;
  }
  c.focus = 0.95 * Math.max(c.height, 0.6 * c.width);
  let target = c.mode === "whole" ? [...box.middle] : state.position;
  let azimuth = c.azimuth, elevation = c.elevation;
  if (c.mode === "follow") {
    const [x, y] = state.speed > 1 ? state.velocity : state.axes[0];
    const wanted = Math.atan2(y, x) + Math.PI;
    if (c.heading === null || seconds === 0) c.heading = wanted;
    const turn = Math.atan2(Math.sin(wanted - c.heading), Math.cos(wanted - c.heading));
    c.heading += turn * (1 - Math.exp(-4 * seconds));
    [azimuth, elevation] = [c.heading, 0.22];
  }
  target = add(target, c.pan);
  const back = [Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)];
  c.eye = add(target, back, c.distance);
  c.ahead = scale(back, -1);
  c.right = unit(cross(c.ahead, [0, 0, 1]));
  c.up = cross(c.right, c.ahead);
}

// A place seen from the camera: right, up, ahead.
const seen = p => {
  const d = add(p, camera.eye, -1);
  return [inner(d, camera.right), inner(d, camera.up), inner(d, camera.ahead)];
};
// Pixels of a seen place that lies ahead.
const pixel = s => {
  const k = camera.flat ? camera.focus : camera.focus / s[2];
  return [0.5 * camera.width + k * s[0], 0.5 * camera.height - k * s[1]];
};
const before = s => camera.flat || s[2] > NEAR;
// Pixels of a metre at a place.
const metre = p => camera.flat ? camera.focus : camera.focus / Math.max(NEAR, seen(p)[2]);

// Corners of a flat shape, seen from the camera, without what comes too near.
function clipped(corners) {
  const out = [];
  corners.forEach((s, i) => {
    const e = corners[(i + 1) % corners.length];
    if (before(s)) out.push(s);
    if (before(s) !== before(e)) out.push(meet(s, e));
  });
  return out;
}

// Where the line between two seen places comes too near.
const meet = (x, y) => add(x, add(y, x, -1), (NEAR + 1e-6 - x[2]) / (y[2] - x[2]));

// A line of the world cut where it comes too near; none where all of it is behind.
function cut(a, b) {
  let [s, e] = [seen(a), seen(b)];
  if (!before(s) && !before(e)) return null;
  if (!before(s)) s = meet(s, e); else if (!before(e)) e = meet(e, s);
  return [pixel(s), pixel(e)];
}
