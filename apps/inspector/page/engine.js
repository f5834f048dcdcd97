"use strict";
// The rasterizer in the page: a WebAssembly module that stands in the page itself, as base64. It is the program's own code, so
// what it draws has the program's own bytes.
class Engine {
  static async start(base64) {
    const engine = new Engine();
    const module = await WebAssembly.compile(Engine.bytesOf(base64));
    // An error leaves the module's functions where they are: the stack is as it was before any of them was called.
    const fail = (at, length) => {
      const text = engine.text(at, length);
      engine.wasm.__stack_pointer.value = engine.stack;
      throw new Error(text);
    };
    const imports = { gnomon: { fail } };
    // The C library asks for files, a clock and arguments; there are none.
    for (const { module: from, name } of WebAssembly.Module.imports(module))
      (imports[from] ||= {})[name] ||= () => 8;
    engine.wasm = (await WebAssembly.instantiate(module, imports)).exports;
    engine.wasm._initialize();
    engine.stack = engine.wasm.__stack_pointer.value;
    return engine;
  }

  static bytesOf(base64) {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
  }

  text(at, length) { return new TextDecoder().decode(new Uint8Array(this.wasm.memory.buffer, at, length)); }

  /// Calls f(address, size) with the bytes in the module's memory.
  lend(bytes, f) {
    const at = this.wasm.allocate(bytes.length);
    if (!at) throw new Error(`there is no memory for ${bytes.length} bytes`);
    try {
      new Uint8Array(this.wasm.memory.buffer, at, bytes.length).set(bytes);
      return f(at, bytes.length);
    } finally {
      this.wasm.release(at);
    }
  }
  result(Type, at) {
    return new Type(this.wasm.memory.buffer.slice(at, at + this.wasm.result_size()));
  }
  resultText(at) { return this.text(at, this.wasm.result_size()); }

  load(slot, bytes) { this.lend(bytes, (at, size) => this.wasm.load(slot, at, size)); }
  /// Returns the state with all fields.
  loadLab(slot, state) {
    return JSON.parse(this.lend(new TextEncoder().encode(JSON.stringify(state)),
      (at, size) => this.resultText(this.wasm.load_lab(slot, at, size))));
  }
  save(slot) { return this.result(Uint8Array, this.wasm.save(slot)); }
  /// In brief, a pass has the number of its commands in their place.
  describe(slot, inBrief = false) { return JSON.parse(this.resultText(this.wasm.describe(slot, inBrief ? 1 : 0))); }
  seek(slot, commands) { this.wasm.seek(slot, commands); }
  /// Row after row from the bottom row. Valid until the next call: a view of the module's memory.
  buffer(slot, number, kind) {
    const at = this.wasm.read_buffer(slot, number), size = this.wasm.result_size(), memory = this.wasm.memory.buffer;
    return kind === "depth" ? new Uint32Array(memory, at, size / 4) : new Uint8Array(memory, at, size);
  }
  /// Counts a pixel, of the draws among commands [first, last).
  fates(slot, first, last) {
    const all = this.result(Uint16Array, this.wasm.fates(slot, first, last)), size = all.length / 5;
    const plane = (i) => all.subarray(i * size, (i + 1) * size);
    return { stencilFailed: plane(0), depthFailed: plane(1), passed: plane(2), raised: plane(3), lowered: plane(4) };
  }
  /// Five numbers an edge: x0, y0, x1, y1 in 1/256 pixel from the bottom left corner, kind.
  wires(slot, command) { return this.result(Int32Array, this.wasm.wires(slot, command)); }
  history(slot, pass, x, y, commands) { return JSON.parse(this.historyText(slot, pass, x, y, commands)); }
  historyText(slot, pass, x, y, commands) { return this.resultText(this.wasm.history(slot, pass, x, y, commands)); }
  hashes(slot) { return this.resultText(this.wasm.hashes(slot)).trim().split("\n"); }
}

/// What both pages begin with: their data, the line for errors (null: none), and the engine.
const startPage = async () => {
  const element = (id) => document.getElementById(id);
  const fail = (error) => {
    element("error").textContent = error ? String(error.message || error) : "";
    element("error").hidden = !error;
  };
  const data = JSON.parse(element("data").textContent);
  const engine = await Engine.start(element("engine").textContent).catch((error) => { fail(error); throw error; });
  return { element, fail, data, engine };
};
