"use strict";
// The stability page: reads what the sweeps found from the page itself, draws a map a sweep.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const element = (id) => document.getElementById(id);
  const add = (parent, tag, text, className) => {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    parent.append(made);
    return made;
  };

  /// Blues below the share from which a method counts as given up, by the logarithm, since a hundredth
  /// of a percent is worth seeing; yellow to dark red from there on. Colour-blind people tell them apart.
  const harmless = [[255, 255, 255], [214, 226, 242], [158, 188, 224], [96, 143, 197]];
  const givenUp = [[255, 226, 120], [230, 140, 30], [190, 60, 20], [110, 20, 20]];
  const color = (share) => {
    if (share <= 0) return harmless[0];
    const log = Math.log10(share), limit = Math.log10(data.givenUp);
    const stops = share < data.givenUp ? harmless : givenUp;
    const part = share < data.givenUp ? (log + 4.5) / (limit + 4.5) : (log - limit) / -limit;
    const at = Math.min(Math.max(part, share < data.givenUp ? 0.1 : 0), 1) * (stops.length - 1);
    const low = Math.floor(at), high = Math.min(low + 1, stops.length - 1);
    return stops[low].map((c, i) => Math.round(c + (stops[high][i] - c) * (at - low)));
  };
  const paint = (cell, share) => {
    const [r, g, b] = color(share);
    cell.style.background = `rgb(${r},${g},${b})`;
    cell.style.color = 0.299 * r + 0.587 * g + 0.114 * b > 140 ? "#111" : "#fff";
  };
  const percent = (share) => {
    const value = 100 * share;
    if (value === 0) return "0";
    if (value < 0.005) return "<0.01";
    return value < 1 ? value.toFixed(2) : value < 10 ? value.toFixed(1) : value.toFixed(0);
  };

  const drawMap = (sweep) => {
    const section = add(element("sweeps"), "section");
    section.id = sweep.name;
    add(section, "h2", sweep.title);
    add(section, "p", sweep.explanation);
    add(section, "p", `Shown: ${sweep.measure}, in percent, against ${sweep.oracle}; ${sweep.inputs} inputs.`);
    const table = add(add(section, "div", undefined, "wide"), "table", undefined, "heat");
    const head = table.createTHead().insertRow();
    add(head, "th", sweep.parameter, "text").scope = "col";
    for (const value of sweep.values) add(head, "th", value).scope = "col";
    const body = table.createTBody();
    for (const method of sweep.methods) {
      const row = body.insertRow();
      add(row, "th", method.name, "text").scope = "row";
      method.cells.forEach((cell, i) => {
        const box = add(row, "td", percent(cell.share));
        box.tabIndex = i === 0 && method === sweep.methods[0] ? 0 : -1;
        paint(box, cell.share);
        if (i === method.border) box.className = "border";
        const text = `${method.name}, ${sweep.parameter} ${sweep.values[i]}: ${cell.wrong.toFixed(cell.wrong % 1 ? 1 : 0)} of ${cell.of} wrong`
          + ` (${percent(cell.share)} %), worst of ${cell.inputs} inputs ${percent(cell.worst)} %`
          + (cell.notFinite ? `, ${cell.notFinite} values not finite` : "");
        box.title = text;
        box.addEventListener("focus", () => { element("status").textContent = text; });
        box.addEventListener("click", () => box.focus());
      });
    }
    table.addEventListener("keydown", (event) => {
      const move = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
      const cell = document.activeElement;
      if (!move || cell.tagName !== "TD") return;
      const row = body.rows[cell.parentElement.sectionRowIndex + move[0]];
      const next = row && row.cells[cell.cellIndex + move[1]];
      if (!next || next.tagName !== "TD") return;
      event.preventDefault();
      cell.tabIndex = -1;
      next.tabIndex = 0;
      next.focus();
    });
  };

  const cells = data.sweeps.flatMap((s) => s.methods.flatMap((m) => m.cells));
  const inputs = data.sweeps.reduce((sum, s) => sum + s.inputs, 0);
  const notFinite = cells.reduce((sum, c) => sum + c.notFinite, 0);
  element("summary").textContent = `${data.sweeps.length} sweeps, ${inputs} inputs, ${cells.length} cells; `
    + `${notFinite} values that are not finite in any buffer. A method gives up from where ${100 * data.givenUp} % or more is wrong.`;
  add(element("legend"), "span", "wrong, in percent:");
  for (const share of [0, 1e-4, 1e-3, 1e-2, 1e-1, 1]) {
    const box = add(element("legend"), "span", percent(share), "swatch");
    paint(box, share);
  }
  for (const sweep of data.sweeps) {
    const link = add(element("contents"), "a", sweep.title);
    link.href = `#${sweep.name}`;
    drawMap(sweep);
  }
})();
