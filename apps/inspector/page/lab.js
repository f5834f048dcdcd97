"use strict";
// The lab: a state, its controls, and the frame that the rasterizer makes of it after every change.
(async () => {
  const { element, fail, data, engine } = await startPage(), { make } = History;
  const slot = 0;
  let state = {}, description = null, count = 0, picked = null;
  const hint = element("history").firstElementChild;

  const stories = {
    "camera-in-shadow": ["The camera in the shadow", "A box throws its shadow on the floor. Tilt the camera and bring it near until it stands in the shadow, with z-pass, then with z-fail: who counts from where?"],
    "missing-cap": ["The missing cap", "The ball's volume is short and has no base (Haller 2003, figure 3). A ray that enters it through its side and leaves where the base should be is never counted out."],
    overflow: ["Overflow", "Plates lie above each other, each with its own volume. Count them in eight bits: what do 256 look like that wrap, and what happens to rays that leave some of 300 when counts stop at 255?"],
    "open-mesh": ["The open mesh", "A box without its lid. Renderers that ask for closed meshes take the triangles that face the light and the edges between them and the rest; compare with the outline as an integer sum over all triangles."],
    acne: ["Acne", "A shadow map of few texels, without an offset: lit surfaces shadow themselves. Find the least offset that stops it, and see what the shadow loses at its foot."],
  };
  const controls = [
    { legend: "Scene", items: [
      { name: "stage", label: "stage", options: Object.entries(stories).map(([value, [text]]) => [value, text]) },
      { name: "plates", label: "plates", range: [1, 600, 1], when: (s) => s.stage === "overflow" }] },
    { legend: "Shadows", items: [
      { name: "method", label: "method", options: [["zpass", "z-pass"], ["zfail", "z-fail"], ["auto", "automatic"], ["map", "shadow map"]] },
      { name: "saturate", label: "counts stop at 0 and 255 (saturate)", when: (s) => s.method !== "map" },
      { name: "front_cap", label: "front cap", when: (s) => s.method !== "map" },
      { name: "back_cap", label: "back cap", when: (s) => s.method !== "map" },
      { name: "length_m", label: "length (0: infinite)", range: [0, 6, 0.05], unit: "m", when: (s) => s.method !== "map" },
      { name: "classical_outline", label: "outline as for closed meshes only", when: (s) => s.method !== "map" },
      { name: "map_size", label: "map size", options: [16, 32, 64, 128, 256, 512, 1024, 2048].map((n) => [n, `${n} texels`]), when: (s) => s.method === "map" },
      { name: "map_offset_factor", label: "offset factor", range: [0, 8, 0.1], when: (s) => s.method === "map" },
      { name: "map_offset_units", label: "offset units", range: [0, 4000, 10], when: (s) => s.method === "map" },
      { name: "map_filtered", label: "filtered (2\u00d72)", when: (s) => s.method === "map" },
      { name: "depth_16_bits", label: "depth of 16 bits" }] },
    { legend: "Camera", items: [
      { name: "camera_turn_deg", label: "turn", range: [-180, 180, 1], unit: "\u00b0" },
      { name: "camera_tilt_deg", label: "tilt", range: [-20, 89, 0.5], unit: "\u00b0" },
      { name: "camera_distance_m", label: "distance", range: [0.2, 14, 0.05], unit: "m" }] },
    { legend: "Lamp", items: ["x", "y", "z"].map((axis) => ({ name: `light_${axis}_m`, label: axis, range: axis === "y" ? [0.05, 10, 0.05] : [-5, 5, 0.05], unit: "m" })) },
    { legend: "Object", items: [
      ...["x", "y", "z"].map((axis) => ({ name: `object_${axis}_m`, label: axis, range: [-2, 2, 0.02], unit: "m" })),
      { name: "object_turn_deg", label: "turn", range: [-180, 180, 1], unit: "\u00b0" }] },
  ];
  const inputs = [];

  const build = () => {
    for (const group of controls) {
      const set = make("fieldset", undefined, element("controls"));
      make("legend", group.legend, set);
      for (const item of group.items) {
        const label = make("label", undefined, set);
        let input;
        if (item.options) {
          make("span", item.label, label);
          input = make("select", undefined, label);
          input.replaceChildren(...item.options.map(([value, text]) => new Option(text, value)));
        } else if (item.range) {
          make("span", item.label, label);
          input = make("input", undefined, label);
          Object.assign(input, { type: "range", min: item.range[0], max: item.range[1], step: item.range[2] });
          item.output = make("output", undefined, label);
        } else {
          input = make("input", undefined, label);
          input.type = "checkbox";
          label.className = "flag";
          label.append(item.label);
        }
        input.id = item.name;
        input.addEventListener(item.options ? "change" : "input", () => change(item, input));
        inputs.push({ item, input, label });
      }
    }
  };
  const change = (item, input) => {
    if (item.name === "stage") {
      try {
        set({ format: "gnomon-lab", version: 1, stage: input.value });
        request();
      } catch (error) { fail(error); }
      return;
    }
    state[item.name] = input.type === "checkbox" ? input.checked : item.range || item.name === "map_size" ? Number(input.value) : input.value;
    request();
  };
  /// A state with the stage's own values where it says nothing.
  const set = (fields) => {
    const before = state;
    state = fields;
    try {
      drawNow();
      picked = view.picked = null;
      element("history").replaceChildren(hint);
    } catch (error) {
      state = before;
      throw error;
    }
  };
  const showControls = () => {
    for (const { item, input, label } of inputs) {
      if (item.options && ![...input.options].some((o) => o.value === String(state[item.name]))) input.add(new Option(state[item.name]));
      if (input.type === "checkbox") input.checked = state[item.name];
      else if (document.activeElement !== input || item.options) input.value = state[item.name];
      if (item.output) item.output.textContent = `${Number(state[item.name].toFixed(2))} ${item.unit || ""}`;
      label.hidden = item.when ? !item.when(state) : false;
    }
    const [title, text] = stories[state.stage], box = element("story");
    if (box.dataset.stage === state.stage) return;
    box.dataset.stage = state.stage;
    box.replaceChildren();
    make("h2", title, box);
    make("p", text, box);
  };

  const passNamed = (begin) => description.passes.findIndex((p) => p.label.startsWith(begin));
  const rangeOf = (p) => {
    const first = description.passes.slice(0, p).reduce((n, pass) => n + pass.commands, 0);
    return [first, first + description.passes[p].commands];
  };

  /// Executes the frame and returns the buffer that is to be shown.
  const execute = () => {
    const show = element("show").value, counting = passNamed("shadow volumes");
    // The lit pass marks what it lit, so counts are looked at before it.
    const stop = show === "stencil" && counting >= 0 ? rangeOf(counting)[1] : count;
    engine.seek(slot, stop);
    const map = passNamed("shadow map"), { targets } = description.passes[0];
    const number = show === "map" ? description.passes[map].targets.depth : targets[show];
    const buffer = description.buffers[number];
    return { ...buffer, values: engine.buffer(slot, number, buffer.kind), farthest: buffer.format === "d16" ? 0xffff : 0xffffff };
  };

  const times = [];
  const drawNow = () => {
    const start = performance.now();
    state = engine.loadLab(slot, state);
    description = engine.describe(slot, true);
    count = rangeOf(description.passes.length - 1)[1];
    const hasMap = passNamed("shadow map") >= 0;
    if (element("show").value === "map" && !hasMap) element("show").value = "color";
    element("show").querySelector("[value=map]").disabled = !hasMap;
    const b = execute();
    // Another buffer's pixel is another one.
    if (picked && (b.width !== view.width || b.height !== view.height)) picked = view.picked = null;
    // A copy: the module's memory is used again.
    view.show(b.kind, b.values.slice(), b.width, b.height, b.farthest);
    const ms = performance.now() - start;
    times.push(ms);
    if (times.length > 20) times.shift();
    const sorted = [...times].sort((x, y) => x - y), median = sorted[sorted.length >> 1];
    element("speed").textContent = `${b.width}\u00d7${b.height} in ${median.toFixed(1)} ms (median of ${times.length}): ${Math.floor(1000 / median)} frames a second`;
    showControls();
    fail(null);
  };
  let layersMs = 0;
  const layers = () => {
    const start = performance.now();
    const counting = passNamed("shadow volumes"), layer = element("layer").value;
    let overlay = null, wires = null;
    if (counting >= 0 && element("wires").checked && element("show").value !== "map") {
      const all = [], [first, last] = rangeOf(counting);
      // The wires of very many volumes hide everything.
      for (let i = first; i < Math.min(last, first + 40); ++i) all.push(engine.wires(slot, i));
      wires = joined(all);
    }
    if (counting >= 0 && layer !== "none" && element("show").value !== "map") {
      const fates = engine.fates(slot, ...rangeOf(counting));
      const [up, down, names] = layer === "counts" ? [fates.raised, fates.lowered, ["INCR", "DECR"]] : [fates.passed, fates.depthFailed, ["passed", "failed"]];
      overlay = twoCounts(up, down, ...names);
    }
    view.setOverlay(overlay?.color, overlay?.note);
    view.setWires(wires);
    showLegend(element("legend"), view, overlay, data.palette);
    layersMs = performance.now() - start;
  };
  /// What takes longer than a frame, once the hand rests.
  let resting = null;
  const rest = (withLayers) => {
    clearTimeout(resting);
    resting = setTimeout(() => {
      try {
        if (withLayers) layers();
        engine.seek(slot, count);
        element("hashes").textContent = engine.hashes(slot).join("\n");
        if (picked) tell(picked.x, picked.y);
        status(view.cursor.x, view.cursor.y);
      } catch (error) { fail(error); }
    }, 60);
  };
  let requested = false;
  const request = () => {
    if (requested) return;
    requested = true;
    requestAnimationFrame(() => {
      requested = false;
      try {
        drawNow();
        // Layers follow the hand where they are quick.
        const quick = layersMs < 30;
        if (quick) layers();
        else {
          view.setOverlay(null);
          view.setWires(null);
        }
        rest(!quick);
      } catch (error) { fail(error); }
    });
  };

  const tell = (x, y) => {
    picked = { x, y };
    const counting = passNamed("shadow volumes"), map = passNamed("shadow map");
    try {
      // Of the map's own pass where the map is looked at.
      const told = engine.history(slot, element("show").value === "map" && map >= 0 ? map : 0, x, y, count), whole = engine.describe(slot);
      History.show(element("history"), told, whole, Math.max(counting, 0), data.palette);
      lab.history = told;
    } catch (error) { fail(error); }
  };
  const status = (x, y) => {
    const box = element("status");
    if (!view.values || x >= view.width || y >= view.height) return;
    const parts = [`pixel ${x}, ${y} from the bottom left`, `${view.kind}: ${view.valueText(x, y)}`];
    if (view.layers.overlay?.note) parts.push(view.layers.overlay.note(y * view.width + x));
    box.replaceChildren();
    for (const part of parts) make("span", part, box);
  };
  const view = new View(element("canvas"), data.palette, { onPick: tell, onMove: status });

  const download = (name, bytes, type) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  element("save").addEventListener("click", () => download("lab.json", JSON.stringify(state, null, 2) + "\n", "application/json"));
  element("saveframe").addEventListener("click", () => download("lab.frame", engine.save(slot), "application/octet-stream"));
  element("open").addEventListener("click", () => element("file").click());
  element("file").addEventListener("change", async () => {
    const [file] = element("file").files;
    if (!file) return;
    try {
      if (file.size > 65536) throw new Error("a state has 65,536 bytes at most");
      set(JSON.parse(await file.text()));
      request();
    } catch (error) { fail(`${file.name}: ${error.message}`); }
    element("file").value = "";
  });
  element("help").addEventListener("click", () => element("helpbox").showModal());
  for (const id of ["show", "layer", "wires"]) element(id).addEventListener("change", request);
  const choose = (id, value) => { element(id).value = value; request(); };
  const keys = {
    c: () => choose("show", "color"), s: () => choose("show", "stencil"), d: () => choose("show", "depth"),
    z: () => { state.method = state.method === "zpass" ? "zfail" : "zpass"; request(); },
    m: () => { state.saturate = !state.saturate; request(); },
    h: () => element("helpbox").showModal(),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("select, dialog") || !keys[event.key.toLowerCase()]) return;
    event.preventDefault();
    keys[event.key.toLowerCase()]();
  });

  leaveAfterMouse();

  window.lab = {
    engine, view, history: null,
    /// Draws a state and returns the hashes of its buffers.
    hashesOf: (given) => { set(given); layers(); engine.seek(slot, count); return engine.hashes(slot); },
    get state() { return state; },
    /// Milliseconds of each of n frames of a camera that turns.
    measure: (n) => {
      const turn = state.camera_turn_deg, all = [];
      for (let i = 0; i < n; ++i) {
        state.camera_turn_deg = turn + i * 0.5;
        const start = performance.now();
        drawNow();
        view.drawNow();
        all.push(performance.now() - start);
      }
      state.camera_turn_deg = turn;
      request();
      return all;
    },
  };
  build();
  set({ format: "gnomon-lab", version: 1, stage: "camera-in-shadow" });
  request();
  document.body.dataset.ready = "yes";
})();
