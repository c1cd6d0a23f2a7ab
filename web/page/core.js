// The C++ core in the page: a module's exports behind plain functions. A refusal is an Error with polhode's sentence.

const zero = () => 0;

async function bytesOf(name) {
  const inlined = globalThis.polhodeModules?.[name];   // gzip in base64, in the page that is one file
  if (!inlined) return (await fetch(name)).arrayBuffer();
  const packed = Uint8Array.from(atob(inlined), c => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

export async function load(name) {
  let wasm;
  const textAt = at => {
    const bytes = new Uint8Array(wasm.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  };
  const module = await WebAssembly.compile(await bytesOf(name));
  const imports = {};
  for (const { module: from, name: what } of WebAssembly.Module.imports(module)) (imports[from] ??= {})[what] = zero;
  if (imports.wasi_snapshot_preview1) {   // no environment: its counts are written, the rest is never asked for
    imports.wasi_snapshot_preview1.environ_sizes_get = (count, size) => {
      new Uint32Array(wasm.memory.buffer, count, 1)[0] = new Uint32Array(wasm.memory.buffer, size, 1)[0] = 0;
      return 0;
    };
  }
  (imports.env ??= {}).raise = at => { throw new Error(textAt(at)); };
  wasm = (await WebAssembly.instantiate(module, imports)).exports;
  wasm._initialize?.();
  const numbers = (at, n) => new Float64Array(wasm.memory.buffer, at, n);
  return { wasm, numbers, textAt };
}

/// The free body at many times: { omega, attitude, period, kind, flips }.
export function throwFree({ wasm, numbers }, start, t, end) {
  const n = t.length, at = wasm.reserve(10 + 8 * n + 64);
  const T = at + 80, W = T + 8 * n, Q = W + 24 * n, F = Q + 32 * n;
  numbers(at, 10).set(start), numbers(T, n).set(t);
  wasm.set_body(at);
  wasm.states(T, n, W, Q);
  const flips = wasm.flips(0, end, F, 64);
  return { omega: numbers(W, 3 * n).slice(), attitude: numbers(Q, 4 * n).slice(), period: wasm.period(), flips };
}

/// Any scene of the page, by the plan (method "") or a method with a step. `torque` is a formula, or empty.
export function solveScene({ wasm, numbers, textAt }, start, t,
                           { torque = "", method = "", step = 0, accuracy = 1e-9 } = {}) {
  const n = t.length, write = (text, reserve) => {
    const letters = new TextEncoder().encode(text);
    new Uint8Array(wasm.memory.buffer, reserve(letters.length), letters.length).set(letters);
  };
  write(method, wasm.reserve_text), write(torque, wasm.reserve_formula);
  const at = wasm.reserve(18 + 8 * n), T = at + 144, W = T + 8 * n, Q = W + 24 * n;
  numbers(at, 18).set(start), numbers(T, n).set(t);
  wasm.solve_scene(at, T, n, accuracy, step, W, Q);
  return { omega: numbers(W, 3 * n).slice(), attitude: numbers(Q, 4 * n).slice(), error: wasm.solve_error(),
           method: textAt(wasm.solve_method()) };
}
