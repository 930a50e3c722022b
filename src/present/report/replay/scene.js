// Draws the world: floor, gates, paths, vehicles, from far to near.

const view = document.getElementById("view");
const pen = view.getContext("2d");
const shown = { names: true, spline: true };
const ORANGE = "#d55e00", BLUE = "#0072b2", SLATE = "#3a444e";

function stroke(lines, colour, width) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.beginPath();
  for (const [a, b] of lines) {
    const line = cut(a, b);
    if (line) { pen.moveTo(...line[0]); pen.lineTo(...line[1]); }
  }
  pen.stroke();
}

function fill(corners, colour) {
  const places = clipped(corners.map(seen));
  if (places.length < 3) return;
  pen.fillStyle = colour;
  pen.beginPath();
  places.map(pixel).forEach(([x, y], i) => i ? pen.lineTo(x, y) : pen.moveTo(x, y));
  pen.fill();
}

function floor() {
  const step = box.size > 120 ? 10 : box.size > 25 ? 2 : 1;
  const ends = [0, 1].map(k => [Math.floor((box.low[k] - 3) / step) * step, Math.ceil((box.high[k] + 3) / step) * step]);
  fill([[ends[0][0], ends[1][0], 0], [ends[0][1], ends[1][0], 0], [ends[0][1], ends[1][1], 0], [ends[0][0], ends[1][1], 0]], "#ffffff");
  const lines = [];
  for (let x = ends[0][0]; x <= ends[0][1]; x += step) lines.push([[x, ends[1][0], 0], [x, ends[1][1], 0]]);
  for (let y = ends[1][0]; y <= ends[1][1]; y += step) lines.push([[ends[0][0], y, 0], [ends[0][1], y, 0]]);
  stroke(lines, "#d9dfe4", 1);
}

const corner = (g, left, up) => add(add(g.centre, g.left, left), g.up, up);

function gate(g, next) {
  const inside = g.radius, outside = 0.5 * g.outer, solid = next ? ORANGE : SLATE;
  const ring = half => [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([l, u]) => corner(g, l * half, u * half));
  const [a, b] = [ring(inside), ring(outside)];
  // Through a gate that stands before the viewer the vehicle is seen.
  pen.globalAlpha = g.virtual ? 0.55 : !camera.flat && seen(g.centre)[2] < 4 ? 0.45 : 0.85;
  if (g.virtual) {
    const round = Array.from({ length: 25 }, (_, k) => corner(g, inside * Math.cos(k * Math.PI / 12), inside * Math.sin(k * Math.PI / 12)));
    pen.setLineDash([6, 5]);
    stroke(round.slice(1).map((p, k) => [round[k], p]), solid, next ? 3 : 1.5);
    pen.setLineDash([]);
  } else {
    for (let k = 0; k < 4; k++) fill([a[k], a[(k + 1) % 4], b[(k + 1) % 4], b[k]], solid);
    stroke([...a.map((p, k) => [p, a[(k + 1) % 4]]), ...b.map((p, k) => [p, b[(k + 1) % 4]])], solid, 1.5);
    const foot = corner(g, 0, -outside);
    if (foot[2] > 0.05) stroke([[foot, [foot[0], foot[1], 0]]], "#9aa4ad", 1.5);
  }
  // The direction of crossing.
  const tip = add(g.centre, g.forward, 0.9);
  stroke([[g.centre, tip], [tip, add(add(tip, g.forward, -0.3), g.left, 0.2)], [tip, add(add(tip, g.forward, -0.3), g.left, -0.2)]], solid, next ? 3 : 1.5);
  pen.globalAlpha = 1;
}

// Names go beside each other where gates stand on top of each other.
function names(target) {
  if (!shown.names || !track) return;
  pen.font = "bold 14px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.lineJoin = "round";
  track.gates.forEach((g, i) => {
    const under = track.gates.slice(0, i).filter(o => Math.hypot(o.centre[0] - g.centre[0], o.centre[1] - g.centre[1]) < 0.5).length;
    const place = camera.flat ? corner(g, 0.5 * g.outer + 0.8 + under, 0) : add(corner(g, 0, 0), [0, 0, g.virtual ? 0 : 0.5 * g.outer + 0.3]);
    const s = seen(place);
    if (!before(s) || (!camera.flat && s[2] > 70)) return;
    const [x, y] = pixel(s);
    pen.lineWidth = 4;
    pen.strokeStyle = "#ffffffd0";
    pen.strokeText(g.label, x, y);
    pen.fillStyle = i === target ? ORANGE : "#15191e";
    pen.fillText(g.label, x, y);
  });
}

// The path in pieces of at most a few metres, with the moment each begins.
function pieces(v, until, chosen) {
  const last = indexAt(v.time, until), stride = Math.max(1, Math.ceil(v.time.length / 1500)), out = [];
  const at = i => v.position.slice(3 * i, 3 * i + 3);
  for (let i = 0; i < v.time.length - 1; i += stride) {
    const j = Math.min(i + stride, v.time.length - 1);
    out.push({ a: at(i), b: at(j), flown: i < last, shade: chosen ? speedOf(v, i) / topSpeed : null });
  }
  return out;
}

function path(v, t, chosen) {
  pen.lineCap = "round";
  const all = pieces(v, t, chosen);
  if (!chosen) {
    stroke(all.filter(p => p.flown).map(p => [p.a, p.b]), "#7d8a9680", 1.5);
    return;
  }
  stroke(all.map(p => [[p.a[0], p.a[1], 0.01], [p.b[0], p.b[1], 0.01]]), "#00000014", 3);
  const LEVELS = 24, buckets = Array.from({ length: 2 * LEVELS }, () => []);
  for (const p of all) buckets[2 * Math.min(LEVELS - 1, Math.floor(p.shade * LEVELS)) + (p.flown ? 1 : 0)].push([p.a, p.b]);
  buckets.forEach((lines, k) => {
    if (!lines.length) return;
    pen.globalAlpha = k % 2 ? 1 : 0.3;
    stroke(lines, shade((k >> 1) / (LEVELS - 1)), k % 2 ? 4 : 2.5);
  });
  pen.globalAlpha = 1;
}

function drone(state, chosen) {
  const [fx, ly, uz] = state.axes, p = state.position;
  const ground = [p[0], p[1], 0.01];
  // From afar it is drawn larger than it is, or it would be a dot.
  const size = Math.max(0.28, 16 / metre(p));
  stroke([[p, ground]], "#00000030", 1);
  const ring = (c, r, n = 14) => Array.from({ length: n }, (_, k) => add(add(c, fx, r * Math.cos(2 * Math.PI * k / n)), ly, r * Math.sin(2 * Math.PI * k / n)));
  const rotors = [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([x, y]) => add(add(add(p, fx, 0.7 * size * x), ly, 0.7 * size * y), uz, 0.12 * size));
  const colour = chosen ? "#15191e" : "#6b7680";
  stroke(rotors.map(r => [p, r]), colour, chosen ? 4 : 2);
  rotors.forEach((r, k) => { pen.globalAlpha = 0.75; fill(ring(r, 0.46 * size), chosen ? (k < 2 ? ORANGE : BLUE) : "#8e99a3"); pen.globalAlpha = 1; });
  if (chosen) {
    stroke([[p, add(p, fx, 1.1 * size)]], ORANGE, 4);
    // Which way, and how hard, it pushes.
    const push = Number.isFinite(state.command[3]) ? 0.5 + 0.5 * state.command[3] : 0;
    stroke([[p, add(p, uz, size * (0.4 + 3 * push))]], BLUE, 2.5);
  }
}

function draw(t, chosen, seconds) {
  const ratio = window.devicePixelRatio || 1, [w, h] = [view.clientWidth, view.clientHeight];
  if (view.width !== Math.round(w * ratio) || view.height !== Math.round(h * ratio)) {
    view.width = Math.round(w * ratio);
    view.height = Math.round(h * ratio);
  }
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  [camera.width, camera.height] = [w, h];
  const states = vehicles.map(v => stateAt(v, t)), state = states[chosen];
  aim(state, seconds);
  pen.fillStyle = "#eef1f4";
  pen.fillRect(0, 0, w, h);
  floor();
  if (shown.spline && track) {
    pen.setLineDash([2, 5]);
    stroke(track.spline.map((p, i) => [p, track.spline[(i + 1) % track.spline.length]]), "#15191e70", 1.2);
    pen.setLineDash([]);
  }
  vehicles.forEach((v, i) => { if (i !== chosen) path(v, t, false); });
  path(vehicles[chosen], t, true);
  const far = p => seen(p)[2];
  const things = states.map((s, i) => ({ z: far(s.position), draw: () => drone(s, i === chosen) }));
  if (track) track.gates.forEach((g, i) => things.push({ z: far(g.centre), draw: () => gate(g, i === state.target) }));
  things.sort((a, b) => b.z - a.z).forEach(thing => thing.draw());
  names(state.target);
  return state;
}
