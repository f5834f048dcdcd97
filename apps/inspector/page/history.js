"use strict";
// What happened at a pixel, as a table of fragments and as the ray's walk in and out of volumes (Haller 2003, figures 2 and 3).
const History = (() => {
  const make = (tag, text, parent, className) => {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    if (parent) parent.append(made);
    return made;
  };
  const opNames = { incr: "+1, stops at 255", incr_wrap: "+1", decr: "\u22121, stops at 0", decr_wrap: "\u22121", replace: "replaced", zero: "set to 0", invert: "inverted", keep: "kept" };
  const number = (v) => v === null ? "NaN" : Number.isInteger(v) ? String(v) : Number(v).toPrecision(4);
  const colorText = (c) => c.map(number).join(" ");
  /// isBytes: 0 to 255 a channel; otherwise 0 to 1.
  const swatch = (parent, c, isBytes) => {
    const part = (v) => Math.round(Math.min(Math.max(isBytes ? v : v * 255, 0), 255));
    const box = make("span", undefined, parent, "chip");
    box.style.background = `rgb(${c.slice(0, 3).map(part).join(" ")})`;
  };
  const change = (parent, name, before, after, isBytes) => {
    if (before === undefined || JSON.stringify(before) === JSON.stringify(after)) return false;
    const line = make("span", `${name} `, parent, "change");
    if (name === "colour") swatch(line, before, isBytes);
    line.append(name === "colour" ? `${colorText(before)} \u2192 ` : `${before} \u2192 `);
    if (name === "colour") swatch(line, after, isBytes);
    line.append(name === "colour" ? colorText(after) : String(after));
    return true;
  };
  const changes = (parent, before, after, isBytes) => {
    const some = [change(parent, "stencil", before.stencil, after.stencil), change(parent, "depth", before.depth, after.depth),
      change(parent, "colour", before.color, after.color, isBytes)].some(Boolean);
    if (!some) make("span", "nothing changes", parent, "quiet");
  };

  const counts = (op) => op.startsWith("incr") ? 1 : op.startsWith("decr") ? -1 : 0;

  /// Does a command count in the stencil?
  const countsIn = ({ state }) => Boolean(state?.stencil) && [state.stencil.front, state.stencil.back].some((f) => counts(f.pass) || counts(f.depth_fail));

  /// The fragments of one pass's last batch of counts: of draws with an operation that counts, since the stencil was last set
  /// otherwise (a clear, or counts that became a flag). commands: of the frame, with their state.
  const walkOf = (history, pass, commands) => {
    let fragments = [], surface, bits = 255;
    for (const command of history.commands) {
      if (command.pass !== pass) continue;
      const drawn = commands[command.command];
      if (!countsIn(drawn)) {
        if (command.kind === "clear" || command.before.stencil !== command.after.stencil) fragments = [];
        continue;
      }
      bits = drawn.state.stencil.front.write_mask;
      for (const f of command.fragments) {
        surface = f.before.depth ?? surface;
        fragments.push({ ...f, draw: command.label, count: counts(f.stencil_op) });
      }
    }
    fragments.sort((a, b) => a.depth - b.depth);
    return { fragments, surface, bits };
  };

  const svg = (tag, attributes, parent, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (text !== undefined) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  };

  const drawWalk = (parent, { fragments, surface }) => {
    if (!fragments.length) return false;
    // More than so many cannot be told apart.
    const shown = fragments.slice(0, 400), stops = shown.map((f) => ({ depth: f.depth, f }));
    let at = stops.findIndex((s) => s.depth >= surface);
    if (at < 0) at = stops.length;
    if (surface !== undefined) stops.splice(at, 0, { depth: surface, isSurface: true });
    const step = Math.max(26, Math.min(70, 600 / stops.length)), width = 70 + step * stops.length + 40, y = 74;
    const picture = svg("svg", { viewBox: `0 0 ${width} 150`, width, height: 150, role: "img", class: "walk" }, parent);
    const front = fragments.filter((f) => f.facing === "front" && f.depth < (surface ?? Infinity)).length;
    const back = fragments.filter((f) => f.facing === "back" && f.depth < (surface ?? Infinity)).length;
    svg("title", {}, picture, `The ray enters ${front} volumes and leaves ${back} before it meets the surface`);
    svg("text", { x: 8, y: y - 12, class: "label" }, picture, "eye");
    svg("circle", { cx: 20, cy: y, r: 6, class: "eye" }, picture);
    let inside = 0, x = 26;
    stops.forEach((stop, i) => {
      const here = 60 + step * i;
      if (inside !== 0) svg("rect", { x, y: y - 16, width: here - x, height: 32, class: inside > 0 ? "in" : "below" }, picture);
      svg("line", { x1: x, y1: y, x2: here, y2: y, class: "ray" }, picture);
      if (inside !== 0 && step >= 26) svg("text", { x: (x + here) / 2, y: y - 20, class: "count" }, picture, String(inside));
      if (stop.isSurface) {
        svg("rect", { x: here - 3, y: y - 30, width: 6, height: 60, class: "surface" }, picture);
        svg("text", { x: here, y: y - 36, class: "label middle" }, picture, "surface");
      } else {
        const enters = stop.f.facing === "front";
        inside += enters ? 1 : -1;
        const group = svg("g", { class: (enters ? "enter" : "leave") + (stop.f.count ? " counted" : "") }, picture);
        svg("title", {}, group, `${stop.f.draw}, triangle ${stop.f.triangle}${stop.f.part ? `, ${stop.f.part}` : ""}: ${stop.f.facing} face at depth ${stop.f.depth}, ${stop.f.outcome}`);
        svg("path", { d: enters ? `M${here - 6} ${y - 9} L${here + 6} ${y} L${here - 6} ${y + 9} Z` : `M${here + 6} ${y - 9} L${here - 6} ${y} L${here + 6} ${y + 9} Z` }, group);
        svg("text", { x: here, y: y + 28, class: "label middle" }, group, enters ? "enter" : "leave");
        svg("text", { x: here, y: y + 44, class: "sign middle" }, group, stop.f.count > 0 ? "+1" : stop.f.count < 0 ? "\u22121" : "\u00b7");
      }
      x = here;
    });
    svg("line", { x1: x, y1: y, x2: width - 8, y2: y, class: "ray" }, picture);
    return true;
  };

  const walkText = ({ fragments, surface, bits }) => {
    const before = fragments.filter((f) => surface === undefined || f.depth < surface);
    const enters = before.filter((f) => f.facing === "front").length, sum = fragments.reduce((s, f) => s + f.count, 0);
    return `Before the surface the ray enters ${enters} and leaves ${before.length - enters}. What is counted adds up to ${sum} (` +
      `${sum & bits} in the stencil, if it wraps and began at 0).${fragments.length > 400 ? " The first 400 faces are drawn." : ""}`;
  };

  const fragmentRow = (body, f, palette, isBytes) => {
    const row = body.insertRow();
    row.className = f.outcome === "passed" ? "passed" : "failed";
    const cell = (text) => { const c = row.insertCell(); if (text !== undefined) c.textContent = text; return c; };
    cell(`${f.triangle}${f.part ? ` (${f.part})` : ""}`);
    cell(f.facing);
    cell(f.before.depth === undefined ? String(f.depth) : `${f.depth} / ${f.before.depth}`);
    cell(f.outcome);
    const stencil = cell();
    if (f.before.stencil !== undefined) {
      for (const value of [f.before.stencil, f.after.stencil]) {
        if (stencil.textContent) stencil.append(" \u2192 ");
        const chip = make("span", undefined, stencil, "chip");
        chip.style.background = `rgb(${palette[value].join(" ")})`;
        stencil.append(String(value));
      }
      make("span", ` ${opNames[f.stencil_op]}`, stencil, "quiet");
    }
    const color = cell();
    if (f.before.color && JSON.stringify(f.before.color) !== JSON.stringify(f.after.color)) {
      swatch(color, f.before.color, isBytes);
      color.append(" \u2192 ");
      swatch(color, f.after.color, isBytes);
      color.append(colorText(f.after.color));
    }
  };

  /// Fills a box. description: of the frame; pass: whose walk is drawn; upTo: the command that the history ends at;
  /// onCommand(command), if given: a command was chosen.
  const show = (box, history, description, pass, palette, { upTo, onCommand } = {}) => {
    box.replaceChildren();
    const commands = description.passes.flatMap((p) => p.commands);
    make("h2", `Pixel ${history.x}, ${history.y}${upTo ? ` up to command ${upTo}` : ""}`, box);
    make("p", `From the bottom left, as in OpenGL. ${history.commands.length} commands touched it.`, box, "quiet");
    const walk = walkOf(history, pass, commands);
    const walkBox = make("div", undefined, box, "walkbox");
    walkBox.tabIndex = 0;
    if (drawWalk(walkBox, walk)) {
      make("p", walkText(walk), box);
      make("p", "Filled: counted; hollow: the depth test left it out. The bar says how many volumes the ray is in, if it begins in none.", box, "quiet");
    }
    else walkBox.remove();
    let last = -1;
    for (const command of history.commands) {
      if (command.pass !== last) make("h3", description.passes[command.pass].label, box);
      last = command.pass;
      const item = make("section", undefined, box, "touched");
      const head = make(onCommand ? "button" : "strong", `${command.command + 1} ${command.kind} ${command.label}`, item);
      if (onCommand) head.addEventListener("click", () => onCommand(command.command));
      const isBytes = description.buffers[description.passes[command.pass].targets.color]?.format === "rgba8";
      const line = make("p", undefined, item);
      changes(line, command.before, command.after, isBytes);
      if (!command.fragments) continue;
      const table = make("table", undefined, item), body = table.createTBody();
      const headRow = table.createTHead().insertRow();
      for (const name of ["triangle", "face", "depth / stored", "outcome", "stencil", "colour"]) make("th", name, headRow).scope = "col";
      for (const f of command.fragments) fragmentRow(body, f, palette, isBytes);
    }
  };
  return { show, make, countsIn };
})();
