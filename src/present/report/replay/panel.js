// Numbers, sticks, the scale of speeds, the line of time with its gates.

const get = id => document.getElementById(id);
const text = (x, digits, unit) => Number.isFinite(x) ? x.toFixed(digits).replace("-", "\u2212") + (unit ? " " + unit : "") : "\u2013";
const label = gate => track && gate !== null && gate !== undefined ? track.gates[gate].label : "\u2013";
const degrees = 180 / Math.PI;

function fillNumbers(v, state, t) {
  const [fx, , uz] = state.axes;
  const tilt = Math.acos(Math.max(-1, Math.min(1, uz[2]))) * degrees;
  const heading = ((Math.atan2(fx[1], fx[0]) * degrees) % 360 + 360) % 360;
  const passed = v.passes.filter(p => p[0] <= t), first = passed.length ? passed[0][1] : null;
  const crossings = passed.filter(p => p[1] === first);
  const running = crossings.length ? t - crossings[crossings.length - 1][0] : NaN;
  const rows = [
    ["speed", text(state.speed, 1, "m/s")],
    ["height", text(state.position[2], 2, "m")],
    ["place", state.position.slice(0, 2).map(x => text(x, 1)).join("  ") + " m"],
    ["tilt, heading", text(tilt, 0, "\u00b0") + "   " + text(heading, 0, "\u00b0")],
    ["rates", state.rates.map(r => text(r === null ? NaN : r * degrees, 0)).join("  ") + " \u00b0/s"],
    ["battery", text(state.voltage === null ? NaN : state.voltage, 2, "V")],
    ["gates passed", String(passed.length)],
    ["next gate", label(state.target)],
    ["lap so far", text(running, 2, "s")],
    ["last lap", text(v.laps[crossings.length - 2], 2, "s")],
  ];
  if (state.over || t >= v.time[v.time.length - 1]) rows.push(["ended", v.failure || "time up or lap done"]);
  const body = get("numbers").tBodies[0];
  body.replaceChildren(...rows.map(([name, value]) => {
    const row = document.createElement("tr");
    for (const content of [name, value]) row.appendChild(document.createElement("td")).textContent = content;
    return row;
  }));
}

const board = get("sticks").getContext("2d");

function stick(x, y, size, right, up, names) {
  board.strokeStyle = "#aeb7bf";
  board.lineWidth = 1;
  board.strokeRect(x, y, size, size);
  board.beginPath();
  board.moveTo(x + size / 2, y); board.lineTo(x + size / 2, y + size);
  board.moveTo(x, y + size / 2); board.lineTo(x + size, y + size / 2);
  board.stroke();
  board.fillStyle = "#48525c";
  board.textAlign = "center";
  board.fillText(names, x + size / 2, y + size + 19);
  if (!Number.isFinite(right) || !Number.isFinite(up)) {
    board.fillText("not recorded", x + size / 2, y + size / 2 - 6);
    return;
  }
  board.fillStyle = "#d55e00";
  board.beginPath();
  board.arc(x + size / 2 * (1 + right), y + size / 2 * (1 - up), 7, 0, 2 * Math.PI);
  board.fill();
}

// What is null in the data is not known.
const known = x => x === null || x === undefined ? NaN : x;

function sticks(state) {
  const [roll, pitch, yaw, thrust] = state.command.map(known);
  // Twice as fine as it is shown, for screens that can.
  board.setTransform(2, 0, 0, 2, 0, 0);
  board.clearRect(0, 0, 380, 180);
  board.font = "17px system-ui, sans-serif";
  const size = 140;
  // Sticks as a pilot holds them: right is a turn to the right, up is nose down.
  stick(10, 14, size, -yaw, thrust, "yaw \u00b7 thrust");
  stick(168, 14, size, roll, pitch, "roll \u00b7 pitch");
  const share = Number.isFinite(thrust) ? 0.5 + 0.5 * thrust : 0;
  for (const [x, part, name, colour] of [[326, share, "T", "#0072b2"], [352, state.speed / topSpeed, "v", shade(state.speed / topSpeed)]]) {
    board.strokeStyle = "#aeb7bf";
    board.strokeRect(x, 14, 16, size);
    board.fillStyle = colour;
    const high = size * Math.min(1, Math.max(0, part));
    board.fillRect(x, 14 + size - high, 16, high);
    board.fillStyle = "#48525c";
    board.textAlign = "center";
    board.fillText(name, x + 8, 14 + size + 19);
  }
}

function drawRamp() {
  const canvas = get("ramp"), ramp = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; x++) {
    ramp.fillStyle = shade(x / canvas.width);
    ramp.fillRect(x, 0, 1, canvas.height);
  }
  get("high").textContent = topSpeed.toFixed(0);
}

// Gates along the line of time.
function ticks(v) {
  const canvas = get("ticks"), width = canvas.clientWidth;
  canvas.width = width;
  const line = canvas.getContext("2d");
  line.font = "11px system-ui, sans-serif";
  line.textAlign = "center";
  let free = -Infinity;
  for (const [time, gate] of v.passes) {
    // The slider's knob is 16 pixels wide, and its middle goes from 8 to width - 8.
    const x = 8 + (width - 16) * (time - span[0]) / (span[1] - span[0] || 1);
    line.fillStyle = "#48525c";
    line.fillRect(x, 12, 1, 4);
    const name = label(gate), half = 0.5 * line.measureText(name).width + 2;
    if (x - half > free) { line.fillText(name, x, 10); free = x + half; }
  }
}
