"use strict";
// The inspector: steps through the frames of the page and shows what each command does.
(async () => {
  const started = performance.now();
  const { element, fail, data, engine } = await startPage(), { make } = History;

  /// A frame with its position: `position` commands were executed, of which the last is looked at.
  class Pane {
    constructor(slot, frame) {
      this.slot = slot;
      engine.load(slot, Engine.bytesOf(frame.bytes));
      this.description = engine.describe(slot);
      this.commands = this.description.passes.flatMap((pass, p) => pass.commands.map((command) => ({ ...command, pass: p })));
      this.ends = [];
      for (const pass of this.description.passes) this.ends.push((this.ends.at(-1) || 0) + pass.commands.length);
      this.position = this.commands.length;
      this.build(frame.name);
    }
    build(name) {
      this.box = make("section", undefined, element("panes"), "pane");
      this.box.setAttribute("aria-label", name);
      const bar = make("div", undefined, this.box, "bar");
      this.name = make("button", name, bar, "name");
      this.name.addEventListener("click", () => activate(this));
      const previous = make("button", "\u2039", bar), slider = make("input", undefined, bar), next = make("button", "\u203a", bar);
      previous.title = "previous command, key ,";
      previous.setAttribute("aria-label", "previous command");
      next.title = "next command, key .";
      next.setAttribute("aria-label", "next command");
      Object.assign(slider, { type: "range", min: 1, max: this.commands.length, value: this.position });
      slider.setAttribute("aria-label", `commands of ${name}`);
      this.slider = slider;
      slider.addEventListener("input", () => { activate(this); go(Number(slider.value)); });
      previous.addEventListener("click", () => { activate(this); go(this.position - 1); });
      next.addEventListener("click", () => { activate(this); go(this.position + 1); });
      const canvas = make("canvas", undefined, this.box);
      canvas.tabIndex = 0;
      canvas.setAttribute("role", "application");
      canvas.setAttribute("aria-label", `${name}: picture; arrow keys move the cursor, Enter tells the pixel's history`);
      canvas.addEventListener("focus", () => { activate(this); this.view.draw(); });
      canvas.addEventListener("blur", () => this.view.draw());
      this.legend = make("div", undefined, this.box, "legend");
      this.view = new View(canvas, data.palette, {
        onPick: (x, y) => { activate(this); tell(x, y); },
        onMove: (x, y) => status(this, x, y),
      });
    }
    get command() { return this.commands[this.position - 1]; }
    get pass() { return this.description.passes[this.command.pass]; }
    /// The first command of a pass and the one behind its last.
    passRange(p) { return [this.ends[p - 1] || 0, this.ends[p]]; }
    /// The buffer that is shown: of the pass's targets the kind that was chosen, or a buffer by its number.
    shown() {
      const choice = element("buffer").value;
      const number = Number(choice.slice(1)), { targets } = this.pass;
      // The buffers are listed as the first frame has them.
      if (choice.startsWith("#") && this.description.buffers[number]?.kind === panes[0].description.buffers[number].kind) return number;
      return targets[choice] ?? targets.color ?? targets.depth ?? targets.stencil;
    }
    read() {
      const before = element("before").getAttribute("aria-pressed") === "true";
      engine.seek(this.slot, before ? this.position - 1 : this.position);
      const number = this.shown(), buffer = this.description.buffers[number];
      const farthest = buffer.format === "d16" ? 0xffff : 0xffffff;
      // A copy: the module's memory is used again.
      return { ...buffer, number, farthest, values: engine.buffer(this.slot, number, buffer.kind).slice() };
    }
    show() {
      const b = this.read();
      this.view.show(b.kind, b.values, b.width, b.height, b.farthest);
      this.buffer = b;
      this.slider.value = this.position;
      this.slider.setAttribute("aria-valuetext", `${this.position}: ${this.command.kind} ${this.command.label || ""}`);
    }
  }

  const panes = [];
  let active = null, playing = null, following = null;

  const activate = (pane) => {
    if (active === pane) return;
    active = pane;
    for (const p of panes) p.box.classList.toggle("active", p === pane);
    list();
    details();
  };

  const list = () => {
    const box = element("commands");
    box.replaceChildren();
    let last = -1;
    active.commands.forEach((command, i) => {
      if (command.pass !== last) {
        const head = make("li", `${command.pass + 1}. ${active.description.passes[command.pass].label}`, box, "pass");
        head.setAttribute("role", "presentation");
      }
      last = command.pass;
      const item = make("li", undefined, box);
      make("span", String(i + 1), item, "number");
      item.append(`${command.kind} ${command.label || ""}`);
      item.id = `command-${i}`;
      item.title = command.label || command.kind;
      item.setAttribute("role", "option");
      item.addEventListener("click", () => go(i + 1));
    });
    select();
  };
  const select = () => {
    active.commands.forEach((_, i) => {
      const item = element(`command-${i}`), selected = i === active.position - 1;
      item.setAttribute("aria-selected", selected);
      item.classList.toggle("ahead", i >= active.position);
      if (selected) item.scrollIntoView({ block: "nearest" });
    });
    element("commands").setAttribute("aria-activedescendant", `command-${active.position - 1}`);
  };

  const stateRows = (rows, state) => {
    const face = (f) => `${f.func} ${f.ref}, masks ${f.read_mask.toString(16)} ${f.write_mask.toString(16)}; fail ${f.fail}, depth fail ${f.depth_fail}, pass ${f.pass}`;
    rows.push(["depth test", state.depth ? `${state.depth.func}${state.depth.write ? ", writes" : ", does not write"}` : "off"]);
    if (state.stencil && JSON.stringify(state.stencil.front) === JSON.stringify(state.stencil.back)) rows.push(["stencil", face(state.stencil.front)]);
    else if (state.stencil) rows.push(["stencil, front", face(state.stencil.front)], ["stencil, back", face(state.stencil.back)]);
    else rows.push(["stencil", "off"]);
    rows.push(["colour mask", state.color_write || "nothing is written"]);
    if (state.blend) rows.push(["blending", `${state.blend.color.join(", ")}; alpha ${state.blend.alpha.join(", ")}`]);
    rows.push(["culled faces", `${state.cull}; front is ${state.front_face}`]);
    if (state.polygon_offset) rows.push(["polygon offset", state.polygon_offset.join(", ")]);
    if (state.scissor) rows.push(["scissor", state.scissor.join(", ")]);
    if (state.depth_clamp) rows.push(["depth clamp", "on"]);
  };
  const details = () => {
    const box = element("command"), { command } = active, rows = [];
    box.replaceChildren();
    make("h2", `${active.position} of ${active.commands.length}: ${command.kind} ${command.label || ""}`, box);
    make("p", active.pass.label, box, "quiet");
    if (command.kind === "draw") {
      rows.push(["triangles", String(command.triangles)], ["shading", command.shading]);
      if (command.parts) rows.push(["parts", command.parts.map((p) => p.label).join(", ")]);
      stateRows(rows, command.state);
    } else {
      for (const name of ["color", "color_write", "depth", "stencil", "stencil_write_mask", "at", "size", "scissor"])
        if (command[name] !== undefined) rows.push([name.replaceAll("_", " "), [command[name]].flat().join(", ")]);
    }
    const terms = make("dl", undefined, box);
    for (const [name, value] of rows) { make("dt", name, terms); make("dd", value, terms); }
  };

  const overlayOf = (pane) => {
    const layer = element("overlay").value, whole = element("scope").value === "pass";
    const range = whole ? pane.passRange(pane.command.pass) : [pane.position - 1, pane.position];
    if (layer === "none") return null;
    const shown = pane.buffer, step = shown.kind === "color" ? 4 : 1;
    /// Of pixel i in two sets of values.
    const differ = (a, b) => (i) => { for (let k = 0; k < step; ++k) if (a[i * step + k] !== b[i * step + k]) return true; return false; };
    if (layer === "differs") {
      const other = panes.find((p) => p !== pane).buffer;
      if (["kind", "format", "width", "height"].some((field) => other[field] !== shown[field])) return unable("the two buffers are not of one format and size");
      return marked(differ(shown.values, other.values), [213, 94, 0, 230], "differs", "the same");
    }
    if (layer === "changed") {
      const read = (position) => { engine.seek(pane.slot, position); return engine.buffer(pane.slot, shown.number, shown.kind).slice(); };
      return marked(differ(read(range[0]), read(range[1])), [230, 159, 0, 220], "changed", "unchanged");
    }
    const [width, height] = pane.pass.size;
    if (width !== shown.width || height !== shown.height) return unable("this buffer is not of the pass's size");
    const fates = engine.fates(pane.slot, ...range);
    if (layer === "counts") return twoCounts(fates.raised, fates.lowered, "INCR", "DECR");
    if (layer === "depth") return twoCounts(fates.passed, fates.depthFailed, "passed", "failed");
    // What failed the depth test had passed the stencil test.
    return twoCounts(fates.passed.map((n, i) => n + fates.depthFailed[i]), fates.stencilFailed, "passed", "failed");
  };
  /// In a layer's place, why there is none.
  const unable = (why) => ({ color: null, note: () => why, legend: [[[255, 255, 255], why]] });

  const wiresOf = (pane) => {
    const choice = element("wires").value;
    if (choice === "none") return null;
    const range = choice === "pass" ? pane.passRange(pane.command.pass) : [pane.position - 1, pane.position], all = [];
    for (let i = range[0]; i < range[1]; ++i) if (pane.commands[i].kind === "draw") all.push(engine.wires(pane.slot, i));
    return joined(all);
  };

  const refresh = () => {
    const start = performance.now();
    try {
      for (const pane of panes) pane.show();
      for (const pane of panes) {
        const overlay = overlayOf(pane);
        pane.view.setOverlay(overlay?.color, overlay?.note);
        pane.view.setWires(wiresOf(pane));
        showLegend(pane.legend, pane.view, overlay, data.palette);
      }
      fail(null);
    } catch (error) {
      if (playing) play();
      fail(error);
      throw error;
    }
    select();
    details();
    status(active, active.view.cursor.x, active.view.cursor.y);
    document.body.dataset.refreshMs = (performance.now() - start).toFixed(1);
  };

  /// The place in another frame whose pass has the same label, the third one if it is the third one here: the same command of
  /// it, or its last one.
  const samePlace = (from, to) => {
    const [first] = from.passRange(from.command.pass), inside = from.position - 1 - first, { label } = from.pass;
    const alike = (passes) => passes.map((pass, p) => p).filter((p) => passes[p].label === label && passes[p].commands.length);
    const p = alike(to.description.passes)[alike(from.description.passes).indexOf(from.command.pass)];
    if (p === undefined) return;
    const [begin, end] = to.passRange(p), last = inside === from.pass.commands.length - 1;
    to.position = last ? end : Math.min(begin + inside + 1, end);
  };
  const go = (position) => {
    active.position = Math.min(Math.max(position, 1), active.commands.length);
    if (element("link").checked) for (const pane of panes) if (pane !== active) samePlace(active, pane);
    refresh();
    // The history ends where one looks; it follows once the hand rests.
    clearTimeout(following);
    if (inspector.history && active.view.picked) following = setTimeout(() => tell(active.view.picked.x, active.view.picked.y, false), 250);
  };
  const goPass = (step) => {
    const { passes } = active.description;
    for (let p = active.command.pass + step; p >= 0 && p < passes.length; p += step)
      if (passes[p].commands.length) return go(active.passRange(p)[1]);
  };

  const tell = (x, y, reveal = true) => {
    const asked = performance.now(), pane = active;
    for (const other of panes) if (other !== pane) { other.view.picked = { x, y }; other.view.draw(); }
    try {
      const told = engine.history(pane.slot, passOf(pane, pane.buffer.number), x, y, pane.position);
      History.show(element("history"), told, pane.description, walkPass(pane), data.palette,
        { upTo: pane.position, onCommand: (command) => { activate(pane); go(command + 1); } });
      inspector.history = told;
      if (reveal) element("history").scrollIntoView({ block: "start" });
    } catch (error) { fail(error); }
    document.body.dataset.historyMs = (performance.now() - asked).toFixed(1);
  };
  /// The last pass up to the place that goes to the buffer.
  const passOf = (pane, buffer) => {
    for (let p = pane.command.pass; p >= 0; --p)
      if (Object.values(pane.description.passes[p].targets).includes(buffer)) return p;
    throw new Error("nothing up to this command goes to this buffer");
  };
  /// The last pass up to the one looked at that counts.
  const walkPass = (pane) => {
    for (let i = pane.position - 1; i >= 0; --i)
      if (History.countsIn(pane.commands[i]) && pane.commands[i].label.startsWith("volume")) return pane.commands[i].pass;
    return pane.command.pass;
  };

  const status = (pane, x, y) => {
    const box = element("status"), i = y * pane.view.width + x, { buffer } = pane;
    if (!buffer || x >= buffer.width || y >= buffer.height) return;
    const parts = [`pixel ${x}, ${y}`, `${buffer.kind === "color" ? "colour" : buffer.kind} ${buffer.format}: ${pane.view.valueText(x, y)}`];
    if (buffer.format === "rgba32f") parts.push("floats, shown as bytes");
    if (buffer.kind === "depth") parts.push((pane.view.values[i] / buffer.farthest).toFixed(7));
    if (pane.view.layers.overlay?.note) parts.push(pane.view.layers.overlay.note(i));
    parts.push(`${buffer.width}\u00d7${buffer.height}`);
    box.replaceChildren();
    for (const part of parts) make("span", part, box);
  };

  const play = () => {
    const button = element("play");
    if (playing) {
      clearInterval(playing);
      playing = null;
    } else {
      if (active.position === active.commands.length) go(1);
      playing = setInterval(() => active.position === active.commands.length ? play() : go(active.position + 1), 350);
    }
    button.textContent = playing ? "stop" : "play";
    button.setAttribute("aria-pressed", Boolean(playing));
  };
  const toggleBefore = () => {
    const button = element("before");
    button.setAttribute("aria-pressed", button.getAttribute("aria-pressed") !== "true");
    refresh();
  };
  const nextOf = (id) => {
    const box = element(id);
    box.selectedIndex = (box.selectedIndex + 1) % box.options.length;
    refresh();
  };
  const choose = (kind) => { element("buffer").value = kind; refresh(); };
  const keys = {
    ".": () => go(active.position + 1), ",": () => go(active.position - 1), "]": () => goPass(1), "[": () => goPass(-1),
    b: toggleBefore, p: play, c: () => choose("color"), d: () => choose("depth"), s: () => choose("stencil"),
    o: () => nextOf("overlay"), w: () => nextOf("wires"), h: () => element("helpbox").showModal(),
    x: () => activate(panes[(panes.indexOf(active) + 1) % panes.length]),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("select, dialog")) return;
    const act = keys[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act();
  });
  element("commands").addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10, Home: -Infinity, End: Infinity }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    go(step === Infinity ? active.commands.length : step === -Infinity ? 1 : active.position + step);
  });
  element("before").addEventListener("click", toggleBefore);
  element("play").addEventListener("click", play);
  element("help").addEventListener("click", keys.h);
  for (const id of ["buffer", "overlay", "scope", "wires"]) element(id).addEventListener("change", refresh);

  leaveAfterMouse();

  element("title").textContent = data.title;
  document.title = `${data.title} - gnomon inspect`;
  const compares = data.frames.length > 1;
  element("linkbox").hidden = !compares;
  if (!compares) element("overlay").querySelector("[value=differs]").remove();
  window.inspector = { engine, panes, go, history: null };
  try {
    data.frames.forEach((frame, slot) => panes.push(new Pane(slot, frame)));
  } catch (error) { fail(error); throw error; }
  const options = [["color", "colour"], ["depth", "depth"], ["stencil", "stencil"]].map(([value, text]) => new Option(`${text} of the pass`, value));
  panes[0].description.buffers.forEach((b, i) => options.push(new Option(`buffer ${i}: ${b.kind} ${b.format} ${b.width}\u00d7${b.height}`, `#${i}`)));
  element("buffer").replaceChildren(...options);
  activate(panes[0]);
  refresh();
  document.body.dataset.readyMs = (performance.now() - started).toFixed(0);
})();
