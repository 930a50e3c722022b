// Time, keys, mouse.

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
// `#t=3.5&camera=top&vehicle=1` in the address opens the page there.
const wish = new URLSearchParams(location.hash.slice(1));
let time = Math.min(span[1], Math.max(span[0], Number(wish.get("t") ?? span[0]) || span[0]));
let playing = false, speed = 1, chosen = 0, stale = true, last = 0;

function show() {
  get("scrub").value = 1000 * (time - span[0]) / (span[1] - span[0] || 1);
  get("clock").textContent = `${(time - span[0]).toFixed(2)} / ${(span[1] - span[0]).toFixed(2)} s`;
  stale = true;
}

function go(t) {
  time = Math.min(span[1], Math.max(span[0], t));
  show();
}

function play(on) {
  if (on && time >= span[1]) go(span[0]);
  playing = on;
  get("play").textContent = on ? "pause" : "play";
}

function choose(i) {
  chosen = (i + vehicles.length) % vehicles.length;
  get("vehicle").value = chosen;
  const v = vehicles[chosen];
  if (!track) {
    get("about").textContent = `${v.time.length} moments; without a track`;
    ticks(v);
    stale = true;
    return;
  }
  const laps = v.laps.length ? "laps " + v.laps.map(l => l.toFixed(2) + " s").join(", ") : "no lap completed";
  get("about").textContent = `${laps}; ${v.passes.length} gates passed` + (v.failure ? `; ended: ${v.failure}` : "");
  ticks(v);
  stale = true;
}

function look(mode) {
  chooseCamera(mode);
  document.querySelectorAll("#cameras button").forEach(b => {
    b.classList.toggle("on", b.dataset.camera === mode);
    b.setAttribute("aria-pressed", b.dataset.camera === mode);
  });
  stale = true;
}

function faster(by) {
  const i = SPEEDS.indexOf(speed) + by;
  if (i >= 0 && i < SPEEDS.length) get("speed").value = speed = SPEEDS[i];
}

function help() { get("help").hidden = !get("help").hidden; }

function frame(by) {
  const v = vehicles[chosen];
  go(v.time[Math.min(v.time.length - 1, Math.max(0, indexAt(v.time, time) + by))]);
}

const KEYS = {
  " ": () => play(!playing), ArrowLeft: e => go(time - (e.shiftKey ? 1 : 0.1)), ArrowRight: e => go(time + (e.shiftKey ? 1 : 0.1)),
  ",": () => frame(-1), ".": () => frame(1), "-": () => faster(-1), "+": () => faster(1), "=": () => faster(1),
  Home: () => go(span[0]), End: () => go(span[1]), 1: () => look("orbit"), 2: () => look("follow"), 3: () => look("top"),
  4: () => look("whole"), v: () => choose(chosen + 1), h: help,
  g: () => { shown.names = !shown.names; stale = true; }, s: () => { shown.spline = !shown.spline; stale = true; },
};

window.addEventListener("keydown", e => {
  // A list that is open keeps its keys.
  if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT" || !KEYS[e.key]) return;
  e.preventDefault();
  KEYS[e.key](e);
});

let drag = null;
view.addEventListener("pointerdown", e => { drag = [e.clientX, e.clientY]; view.setPointerCapture(e.pointerId); view.focus(); });
view.addEventListener("pointerup", () => { drag = null; });
view.addEventListener("pointermove", e => {
  if (!drag) return;
  const [dx, dy] = [e.clientX - drag[0], e.clientY - drag[1]];
  drag = [e.clientX, e.clientY];
  if (e.shiftKey || camera.flat || e.buttons === 2) {
    const k = camera.flat ? 1 / camera.focus : camera.distance / camera.focus;
    camera.pan = add(add(camera.pan, camera.right, -dx * k), camera.up, dy * k);
  } else {
    camera.azimuth -= 0.006 * dx;
    camera.elevation = Math.min(1.5, Math.max(-0.1, camera.elevation + 0.006 * dy));
    if (camera.mode === "follow") look("orbit");
  }
  stale = true;
});
view.addEventListener("wheel", e => {
  e.preventDefault();
  const k = Math.exp(0.001 * e.deltaY);
  camera.distance = Math.min(400, Math.max(1.5, camera.distance * k));
  camera.topSpan = Math.min(20, Math.max(0.2, camera.topSpan / k));
  stale = true;
}, { passive: false });
view.addEventListener("contextmenu", e => e.preventDefault());

get("title").textContent = data.title;
get("vehicle").replaceChildren(...vehicles.map((v, i) => new Option(v.name, i)));
get("choice").hidden = vehicles.length < 2;
get("speed").replaceChildren(...SPEEDS.map(s => new Option(s + "\u00d7", s)));
get("speed").value = speed;
get("vehicle").addEventListener("change", e => choose(Number(e.target.value)));
get("speed").addEventListener("change", e => { speed = Number(e.target.value); });
get("scrub").addEventListener("input", e => go(span[0] + (span[1] - span[0]) * e.target.value / 1000));
get("play").addEventListener("click", () => play(!playing));
get("helper").addEventListener("click", help);
document.querySelectorAll("#cameras button").forEach(b => b.addEventListener("click", () => look(b.dataset.camera)));
window.addEventListener("resize", () => { ticks(vehicles[chosen]); stale = true; });

function picture(now) {
  const seconds = Math.min(0.1, (now - last) / 1000);
  last = now;
  if (playing) {
    go(time + speed * seconds);
    if (time >= span[1]) play(false);
  }
  if (stale) {
    stale = false;
    const state = draw(time, chosen, playing ? seconds : 0);
    fillNumbers(vehicles[chosen], state, time);
    sticks(state);
    document.body.dataset.drawn = time.toFixed(3);
  }
  requestAnimationFrame(picture);
}

drawRamp();
look(["orbit", "follow", "top", "whole"].includes(wish.get("camera")) ? wish.get("camera") : track ? "whole" : "orbit");
choose(Number(wish.get("vehicle")) || 0);
show();
requestAnimationFrame(picture);
