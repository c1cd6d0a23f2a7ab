import { load, solveScene, throwFree } from "./core.js";
import { View, drawErrors, rotate } from "./draw.js";

const get = id => document.getElementById(id);
const FIELDS = ["a", "b", "c", "w1", "w2", "w3", "weight", "arm", "tilt", "wheel", "rate"];
const PRESETS = {
  racket: { a: 0.7, b: 0.25, c: 0.05, w1: 0.01, w2: 7, w3: 0.01 },
  near: { a: 0.7, b: 0.25, c: 0.05, w1: 1e-6, w2: 7, w3: 1e-6 },
  book: { a: 0.3, b: 0.22, c: 0.05, w1: 2, w2: 3, w3: 4 },
  disk: { a: 0.5, b: 0.5, c: 0.04, w1: 1, w2: 0, w3: 8 },
  top: { a: 0.4, b: 0.3, c: 0.2, w1: 0, w2: 0, w3: 14, weight: 10, arm: 0.12, tilt: 30 },
  wheel: { a: 0.7, b: 0.25, c: 0.05, w1: 0.3, w2: 3, w3: 0.1, wheel: 0.2 },
  brake: { a: 0.3, b: 0.22, c: 0.05, w1: 2, w2: 3, w3: 4, torque: "-0.002 * omega * norm(omega)" },
};
const REST = { weight: 0, arm: 0.1, tilt: 0, wheel: 0, rate: 60, torque: "", moments: null, attitude: null };
const METHODS = ["euler", "semi_euler", "catto", "jolt", "buss", "split", "dmv2", "rk4", "free"];
const SPAN = 20, FRAMES = 120;   // [s], and states a second
const DENSITY = 900;             // [kg/m^3]
const COLORS = ["#b3392f", "#e0584c", "#2f6fb3", "#4c8fe0", "#3f8f4f", "#58b36b"];

const state = { ...REST, ...PRESETS.racket, method: "semi_euler" };
const cores = {};
let compared = [], exact = null, polhode = null, other = null, clock = 0, playing = true, asked = 0;
const bodyView = new View(get("body")), ellipsoidView = new View(get("ellipsoid"));

const times = Float64Array.from({ length: SPAN * FRAMES + 1 }, (_, i) => i / FRAMES);

function massAndMoments() {
  if (state.moments) return [...state.moments];   // of a scene's address; about the pivot, where there is one
  const { a, b, c } = state, mass = DENSITY * a * b * c;
  const own = [b * b + c * c, a * a + c * c, a * a + b * b].map(s => mass / 12 * s);
  if (state.weight > 0) own[0] += mass * state.arm ** 2, own[1] += mass * state.arm ** 2;   // about the pivot
  return own;
}

const isFree = () => !(state.weight > 0) && !state.wheel && !state.torque;
const solve = (t, options = {}) => solveScene(cores.solve, fullStart(), t, { torque: state.torque, ...options });

function start() {
  const half = state.tilt * Math.PI / 360, attitude = state.attitude ?? [Math.sin(half), 0, 0, Math.cos(half)];
  return [...massAndMoments(), state.w1, state.w2, state.w3, ...attitude];
}

const fullStart = () => [...start(), state.weight, 0, 0, state.arm, 0, 0, 1, state.wheel];

function angles(p, q) {
  return Float64Array.from({ length: p.length / 4 }, (_, i) => {
    const [a, b] = [p, q].map(x => x.subarray(4 * i, 4 * i + 4));
    const dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3], s = dot < 0 ? -1 : 1;
    return 2 * Math.hypot(a[0] - s * b[0], a[1] - s * b[1], a[2] - s * b[2], a[3] - s * b[3]);
  });
}

/// A refusal is shown with polhode's own sentence, and the page lives on.
function guarded(work) {
  try {
    work();
    get("refusal").hidden = true;
  } catch (error) {
    get("refusal").textContent = error.message, get("refusal").hidden = false;
  }
}

function recompute() {
  const began = performance.now();
  guarded(() => {
    exact = other = null;
    exact = isFree() ? throwFree(cores.free, start(), times, SPAN) : solve(times);
  });
  state.cost = performance.now() - began;
  polhode = exact && traceContact(exact.omega);
  tellFacts(), save();
  clearTimeout(asked), asked = setTimeout(compare, 60);
}

/// The stepping methods at the page's steps a second, against the exact motion.
function compare() {
  if (!cores.solve || !exact) return;
  const step = 1 / state.rate, curves = [];
  const grid = Float64Array.from({ length: SPAN * state.rate + 1 }, (_, i) => i * step);
  guarded(() => {
    const truth = isFree() ? throwFree(cores.free, start(), grid, SPAN) : solve(grid);
    for (const name of METHODS) {
      const run = solve(grid, { method: name, step });
      curves.push({ name, t: grid, error: angles(run.attitude, truth.attitude), chosen: name === state.method });
      if (name === state.method) other = { ...run, rate: state.rate };
    }
  });
  get("other").textContent = get("method").selectedOptions[0].text;
  compared = curves, drawErrors(get("errors"), SPAN, compared);
}

const number = x => Math.abs(x) >= 1e5 || (x && Math.abs(x) < 1e-3) ? x.toExponential(6) : x.toPrecision(7);

function tellFacts() {
  if (!exact) return;
  const parts = [`moments ${massAndMoments().map(m => m.toPrecision(4)).join(", ")} kg m²`];
  if (exact.period > 0) parts.push(`period ${Number.isFinite(exact.period) ? number(exact.period) + " s" : "infinite"}`);
  if (isFree()) parts.push(`${exact.flips} flips in ${SPAN} s`);
  else parts.push(`solved by ${exact.method}, error below ${exact.error.toExponential(1)}`);
  get("facts").textContent = `${parts.join("; ")}. ${times.length} states in ${state.cost.toFixed(1)} ms.`;
}

function quatAt(run, rate, t) {
  const i = Math.min(Math.round(t * rate), run.attitude.length / 4 - 1);
  return run.attitude.subarray(4 * i, 4 * i + 4);
}

function drawBody(t) {
  const half = [state.a, state.b, state.c].map(s => s / 2), shift = state.weight > 0 ? [0, 0, state.arm] : [0, 0, 0];
  bodyView.scale = 1.15 * Math.hypot(...half) + (state.weight > 0 ? state.arm : 0);
  bodyView.clear();
  const trail = [], now = Math.round(t * FRAMES);
  for (let i = Math.max(0, now - 2 * FRAMES); i <= now; ++i)
    trail.push(rotate(exact.attitude.subarray(4 * i, 4 * i + 4), [0, 0, bodyView.scale * 0.85]));
  bodyView.line(trail, "--faint", 1.5);
  bodyView.box(half, quatAt(exact, FRAMES, t), shift, COLORS, "rgba(0,0,0,.45)");
  if (other) bodyView.box(half, quatAt(other, other.rate, t), shift, null, "--other");
}

/// The half axes of the ellipsoid x.I.x = 1, and the largest, by which the picture is divided.
function semiAxes() {
  const semi = massAndMoments().map(m => 1 / Math.sqrt(m));
  return { semi, most: Math.max(...semi) };
}

/// The point of contact omega / sqrt(2 T) at every time, in the picture's units.
function traceContact(omega) {
  const I = massAndMoments(), { most } = semiAxes();
  return Array.from({ length: omega.length / 3 }, (_, i) => {
    const w = omega.subarray(3 * i, 3 * i + 3), T2 = w[0] * w[0] * I[0] + w[1] * w[1] * I[1] + w[2] * w[2] * I[2];
    return Array.from(w, x => T2 > 0 ? x / Math.sqrt(T2) / most : 0);
  });
}

function drawEllipsoid(t) {
  const { semi, most } = semiAxes();
  const view = ellipsoidView;
  view.scale = 1.0, view.clear();
  for (let axis = 0; axis < 3; ++axis) for (const level of [-0.6, 0, 0.6]) {
    const ring = [], u = (axis + 1) % 3, v = (axis + 2) % 3, r = Math.sqrt(1 - level * level);
    for (let k = 0; k <= 64; ++k) {
      const p = [0, 0, 0], angle = k * Math.PI / 32;
      p[axis] = level * semi[axis] / most;
      p[u] = r * Math.cos(angle) * semi[u] / most, p[v] = r * Math.sin(angle) * semi[v] / most;
      ring.push(p);
    }
    view.line(ring, "--line", 1);
  }
  view.line(polhode, "--accent", 2);
  view.dot(polhode[Math.round(t * FRAMES)], "--other");
}

function frame(last) {
  const now = performance.now();
  if (playing && exact) clock = (clock + Math.min(now - last, 100) / 1000) % SPAN;
  if (exact) {
    get("time").value = clock / SPAN, get("now").textContent = `${clock.toFixed(2)} s`;
    drawBody(clock), drawEllipsoid(clock);
  }
  requestAnimationFrame(() => frame(now));
}

function show() {
  for (const id of [...FIELDS, "torque"]) get(id).value = state[id];
  for (const out of document.querySelectorAll("form output")) out.textContent = Number(state[out.htmlFor.value]).toFixed(2);
  get("method").value = state.method;
}

/// The link holds the scene.
function save() {
  const words = new URLSearchParams();
  for (const id of [...FIELDS, "method", "torque"]) words.set(id, state[id]);
  for (const id of ["moments", "attitude"]) if (state[id]) words.set(id, state[id].join(","));
  history.replaceState(null, "", `#${words}`);
}

function restore() {
  for (const [id, value] of new URLSearchParams(location.hash.slice(1))) {
    if (FIELDS.includes(id) && Number.isFinite(Number(value))) state[id] = Number(value);
    if (id === "torque") state.torque = value;
    const list = value.split(",").map(Number), whole = list.every(Number.isFinite);
    if (id === "moments" && list.length === 3 && whole) state.moments = list;
    if (id === "attitude" && list.length === 4 && whole) state.attitude = list;
    if (id === "method" && METHODS.includes(value)) state.method = value;
  }
}

function sceneText() {
  const lines = ["# polhode run scene.toml", "[body]", `moments = [${massAndMoments().join(", ")}]`, "", "[start]",
                 `omega = [${[state.w1, state.w2, state.w3].map(Number).join(", ")}]`,
                 `attitude = [${start().slice(6).join(", ")}]`];
  if (state.weight > 0)
    lines.push("", "[[torques]]", 'kind = "gravity"', `weight = ${state.weight}`, `arm = [0.0, 0.0, ${state.arm}]`);
  if (state.torque) lines.push("", "[[torques]]", 'kind = "formula"', `torque = ${JSON.stringify(state.torque)}`);
  if (state.wheel) lines.push("", "[[rotors]]", "axis = [0.0, 0.0, 1.0]", `momentum = ${state.wheel}`);
  lines.push("", "[times]", `span = ${SPAN.toFixed(1)}`, `samples = ${SPAN * 50 + 1}`, "");
  return lines.join("\n").replace(/(?<=[=\[, ])(-?\d+)(?=[,\]\n])/g, "$1.0").replace(/samples = (\d+)\.0/, "samples = $1");
}

function listen() {
  for (const id of FIELDS) get(id).addEventListener("input", event => {
    state[id] = Number(event.target.value);
    if ("abc".includes(id)) state.moments = null;   // the sides, or the tilt, count again
    if (id === "tilt") state.attitude = null;
    show(), recompute();
  });
  get("torque").addEventListener("change", event => { state.torque = event.target.value.trim(), recompute(); });
  get("method").addEventListener("input", event => { state.method = event.target.value, recompute(); });
  get("preset").addEventListener("input", event => {
    Object.assign(state, REST, PRESETS[event.target.value]), clock = 0, show(), recompute();
  });
  const toggle = () => {
    playing = !playing;
    get("play").textContent = playing ? "Pause" : "Play", get("play").ariaPressed = String(playing);
  };
  get("play").addEventListener("click", toggle);
  addEventListener("keydown", event => {
    if (event.key === " " && event.target === document.body) event.preventDefault(), toggle();
  });
  get("time").addEventListener("input", event => { clock = SPAN * event.target.value; });
  get("link").addEventListener("click", async () => {
    save();
    try { await navigator.clipboard.writeText(location.href), get("told").textContent = "copied"; }
    catch { get("told").textContent = "the address bar holds the link"; }
  });
  get("toml").addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([sceneText()])), link.download = "scene.toml", link.click();
  });
  addEventListener("resize", () => drawErrors(get("errors"), SPAN, compared));
  const drag = (view, move) => {
    let from = null;
    view.canvas.addEventListener("pointerdown", e => { from = e, view.canvas.setPointerCapture(e.pointerId); });
    view.canvas.addEventListener("pointerup", () => { from = null; });
    view.canvas.addEventListener("pointermove", e => { if (from) move(e, from), from = e; });
  };
  drag(bodyView, (e, from) => bodyView.turn((from.clientX - e.clientX) / 150, (e.clientY - from.clientY) / 150));
  drag(ellipsoidView, e => pickSpin(e));
}

/// The spin from the point under the pointer: omega along it, with the energy unchanged.
function pickSpin(event) {
  const I = massAndMoments(), { semi, most } = semiAxes(), view = ellipsoidView;
  const frame = view.canvas.getBoundingClientRect(), ratio = view.canvas.width / frame.width;
  const target = [(event.clientX - frame.left) * ratio, (event.clientY - frame.top) * ratio];
  let best = null, nearest = Infinity;
  for (let k = 0; k < 4000; ++k) {   // Fibonacci's points on the sphere: close enough for a finger
    const z = 1 - (2 * k + 1) / 4000, r = Math.sqrt(1 - z * z), angle = 2.399963229728653 * k;
    const p = [r * Math.cos(angle) * semi[0] / most, r * Math.sin(angle) * semi[1] / most, z * semi[2] / most];
    const [x, y, depth] = view.project(p);
    const distance = (x - target[0]) ** 2 + (y - target[1]) ** 2 + (depth < 0 ? 1e9 : 0);
    if (distance < nearest) nearest = distance, best = p;
  }
  const T2 = I.reduce((sum, m, i) => sum + m * [state.w1, state.w2, state.w3][i] ** 2, 0) || 1;
  [state.w1, state.w2, state.w3] = best.map(x => +(x * most * Math.sqrt(T2)).toPrecision(4));
  clock = 0, show(), recompute();
}

restore(), show(), listen();
cores.free = await load("free.wasm");
if (isFree()) recompute();
requestAnimationFrame(() => frame(performance.now()));
cores.solve = await load("solve.wasm");
recompute();
document.body.dataset.ready = "yes";
globalThis.playground = { state, recompute, sceneText };
