// The data of the page, and where a vehicle is at a time.

const data = JSON.parse(document.getElementById("data").textContent);
const { track, vehicles } = data;
const speedOf = (v, i) => Math.hypot(v.velocity[3 * i], v.velocity[3 * i + 1], v.velocity[3 * i + 2]);
const span = [Math.min(...vehicles.map(v => v.time[0])), Math.max(...vehicles.map(v => v.time[v.time.length - 1]))];
// Far out of thousands of moments a few may be wild: the scale ends where nearly all of them do.
const speeds = vehicles.flatMap(v => v.time.map((_, i) => speedOf(v, i))).sort((a, b) => a - b);
const topSpeed = Math.max(1, speeds[Math.floor(0.995 * (speeds.length - 1))]);

// Index of the last moment that is not after t, at least 0.
function indexAt(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

// State of a vehicle at a time: places and attitude between moments, commands held.
function stateAt(v, t) {
  const i = indexAt(v.time, t), j = Math.min(i + 1, v.time.length - 1);
  const gap = v.time[j] - v.time[i];
  const part = gap > 0 ? Math.min(1, Math.max(0, (t - v.time[i]) / gap)) : 0;
  const mix = (list, n) => Array.from({ length: n }, (_, k) => list[n * i + k] + part * (list[n * j + k] - list[n * i + k]));
  const dot = [0, 1, 2, 3].reduce((sum, k) => sum + v.attitude[4 * i + k] * v.attitude[4 * j + k], 0);
  const sign = dot < 0 ? -1 : 1;
  let q = [0, 1, 2, 3].map(k => v.attitude[4 * i + k] * (1 - part) + sign * part * v.attitude[4 * j + k]);
  const size = Math.hypot(...q) || 1;
  q = q.map(x => x / size);
  const velocity = mix(v.velocity, 3);
  return {
    index: i, position: mix(v.position, 3), velocity, speed: Math.hypot(...velocity), attitude: q, axes: axesOf(q),
    rates: v.rates.slice(3 * i, 3 * i + 3), command: v.command.slice(4 * i, 4 * i + 4),
    voltage: v.voltage[i], target: v.target[i], over: t > v.time[v.time.length - 1],
  };
}

// The body's axes in the world.
function axesOf([w, x, y, z]) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}

// Dark to bright, in order also for readers who see no hue (viridis, without its pale end, which white would swallow).
const STOPS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [236, 214, 30]];
function shade(share) {
  const at = Math.min(1, Math.max(0, share)) * (STOPS.length - 1), i = Math.min(STOPS.length - 2, Math.floor(at));
  return "rgb(" + STOPS[i].map((c, k) => Math.round(c + (at - i) * (STOPS[i + 1][k] - c))).join(",") + ")";
}
