"use strict";
// The chart page: reads the points from the page itself, shows one scene at a time.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const element = (id) => document.getElementById(id);
  // Okabe and Ito 2008: colours that colour-blind people tell apart.
  const colors = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9", "#8c6d1f"];
  const shapes = ["circle", "triangle", "rect", "rectRot", "star", "cross", "crossRot", "rectRounded"];
  const families = [...new Set(data.scenes.flatMap((s) => s.points.map((p) => p.family)))];
  let chart = null, chosen = null;

  const scene = () => data.scenes[element("scene").selectedIndex];
  const error = () => Math.max(element("error").selectedIndex, 0);
  const number = (value) => value === 0 ? "0" : Math.abs(value) >= 100 ? value.toFixed(0) : value.toPrecision(3);

  /// Points that no other one beats in both, from the fastest on.
  const front = (points) => {
    const timed = points.filter((p) => p.ms).sort((a, b) => a.ms.median - b.ms.median || a.errors[error()] - b.errors[error()]);
    const kept = [];
    for (const p of timed)
      if (!kept.length || p.errors[error()] < kept[kept.length - 1].errors[error()]) kept.push(p);
    return kept;
  };

  /// On a logarithmic axis nothing is at 0: what is gets a place of its own below all others.
  const lowest = (points) => {
    const positive = points.map((p) => p.errors[error()]).filter((e) => e > 0);
    return positive.length ? Math.min(...positive) / 3 : 1e-3;
  };

  const show = (point) => {
    chosen = point;
    const box = element("detail");
    box.replaceChildren();
    const add = (tag, text, parent = box) => {
      const made = document.createElement(tag);
      if (text !== undefined) made.textContent = text;
      parent.append(made);
      return made;
    };
    add("strong", point.method);
    const list = add("dl");
    const row = (name, value) => { add("dt", name, list); add("dd", value, list); };
    if (point.ms) row("ms", `${number(point.ms.median)} (${number(point.ms.low)} to ${number(point.ms.high)}, ${point.ms.frames} frames)`);
    scene().errors.forEach((name, i) => row(name, number(point.errors[i])));
    for (const [image, what] of [[point.picture, "picture"], [point.difference, "where it is wrong"]]) {
      if (image === undefined) continue;
      const picture = add("img");
      picture.src = data.images[image];
      picture.alt = `${point.method}: ${what}`;
    }
    for (const line of element("table").querySelectorAll("tbody tr"))
      line.classList.toggle("chosen", line.point === point);
  };

  const drawTable = () => {
    const table = element("table"), on = new Set(front(scene().points));
    table.replaceChildren();
    const head = table.createTHead().insertRow();
    for (const [i, name] of ["method", "family", "ms", "least", "most", ...scene().errors].entries()) {
      const cell = document.createElement("th");
      cell.textContent = name;
      cell.scope = "col";
      if (i < 2) cell.className = "text";
      head.append(cell);
    }
    const body = table.createTBody();
    const sorted = [...scene().points].sort((a, b) => (a.ms ? a.ms.median : 0) - (b.ms ? b.ms.median : 0));
    for (const point of sorted) {
      const line = body.insertRow();
      line.tabIndex = 0;
      line.point = point;
      if (on.has(point)) line.className = "front";
      line.insertCell().textContent = point.method;
      const family = line.insertCell();
      family.textContent = point.family;
      family.className = "text";
      for (const key of ["median", "low", "high"]) line.insertCell().textContent = point.ms ? number(point.ms[key]) : "";
      for (const value of point.errors) line.insertCell().textContent = number(value);
      line.addEventListener("focus", () => show(point));
      line.addEventListener("click", () => show(point));
    }
  };

  /// From the least to the most time.
  const spread = {
    id: "spread",
    afterDatasetsDraw(shown) {
      const { ctx, scales: { x, y } } = shown;
      ctx.save();
      ctx.lineWidth = 1;
      for (const set of shown.data.datasets) {
        if (!set.points) continue;
        ctx.strokeStyle = set.borderColor;
        for (const at of set.data) {
          ctx.beginPath();
          ctx.moveTo(x.getPixelForValue(at.point.ms.low), y.getPixelForValue(at.y));
          ctx.lineTo(x.getPixelForValue(at.point.ms.high), y.getPixelForValue(at.y));
          ctx.stroke();
        }
      }
      ctx.restore();
    },
  };

  const drawChart = () => {
    const points = scene().points, log = element("log").checked, floor = lowest(points);
    const place = (p) => ({ x: p.ms.median, y: log ? Math.max(p.errors[error()], floor) : p.errors[error()], point: p });
    const sets = families.map((family, i) => ({
      label: family,
      points: true,
      data: points.filter((p) => p.ms && p.family === family).map(place),
      backgroundColor: colors[i % colors.length],
      borderColor: colors[i % colors.length],
      pointStyle: shapes[i % shapes.length],
      radius: 5,
      hoverRadius: 8,
    })).filter((set) => set.data.length);
    sets.push({
      label: "front", type: "line", pointStyle: "line", data: front(points).map(place), borderColor: "#777", borderWidth: 1.5,
      borderDash: [5, 4], pointRadius: 0, pointHitRadius: 0, stepped: "before", fill: false,
    });
    if (chart) chart.destroy();
    chart = new Chart(element("chart"), {
      type: "scatter",
      data: { datasets: sets },
      plugins: [spread],
      options: {
        animation: false,
        maintainAspectRatio: false,
        onHover: (event, found) => {
          const at = found.map((f) => chart.data.datasets[f.datasetIndex].data[f.index]).find((d) => d.point);
          if (at && at.point !== chosen) show(at.point);
        },
        scales: {
          x: { type: log ? "logarithmic" : "linear", title: { display: true, text: "milliseconds a frame" } },
          y: {
            type: log ? "logarithmic" : "linear",
            min: log ? floor * 0.7 : 0,
            afterBuildTicks: (axis) => { if (log) axis.ticks = [{ value: floor }, ...axis.ticks.filter((t) => t.value > floor * 2)]; },
            title: { display: true, text: scene().errors[error()] },
            ticks: { callback: (value) => !log || value > floor * 1.001 ? number(value) : value > floor * 0.999 ? "0" : "" },
          },
        },
        plugins: {
          legend: { labels: { usePointStyle: true } },
          tooltip: { callbacks: { label: (at) => at.raw.point ? `${at.raw.point.method}: ${number(at.raw.point.ms.median)} ms, ${number(at.raw.point.errors[error()])}` : "" } },
        },
      },
    });
  };

  const draw = () => {
    element("oracle").textContent = `Errors are against: ${scene().oracle}.`;
    drawTable();
    drawChart();
    const best = front(scene().points);
    if (best.length || scene().points.length) show(best[best.length - 1] || scene().points[0]);
  };
  const chooseScene = () => {
    element("error").replaceChildren(...scene().errors.map((name) => new Option(name)));
    draw();
  };
  element("scene").replaceChildren(...data.scenes.map((s) => new Option(s.name)));
  element("scene").addEventListener("change", chooseScene);
  element("error").addEventListener("change", draw);
  element("log").addEventListener("change", draw);
  chooseScene();
})();
