"use strict";
// One buffer on a canvas: zoom, pan, a pixel cursor, overlays, wires, and the numbers themselves where a pixel is large enough.
// Coordinates are OpenGL's: (0, 0) is the bottom left pixel.
class View {
  /// onPick(x, y): a pixel was chosen by click or Enter. onMove(x, y): the cursor moved.
  constructor(canvas, palette, { onPick, onMove }) {
    Object.assign(this, { canvas, palette, onPick, onMove });
    this.width = this.height = 1;
    this.scale = 0;
    this.left = this.top = 0;
    this.cursor = { x: 0, y: 0 };
    this.picked = null;
    this.layers = { overlay: null, wires: null };
    this.content = document.createElement("canvas");
    this.overlayContent = document.createElement("canvas");
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  /// values: rows from the bottom. range: of depth, the least and the most that are shown apart.
  show(kind, values, width, height, farthest = 0) {
    const resized = width !== this.width || height !== this.height;
    Object.assign(this, { kind, values, width, height, farthest });
    if (resized || !this.scale) {
      this.cursor = { x: width >> 1, y: height >> 1 };
      this.fit();
    }
    this.paint(this.content, (pixels) => this.fill(pixels));
    this.draw();
  }

  /// Writes a picture's 32-bit pixels from the top row.
  paint(target, fill) {
    if (target.width !== this.width || target.height !== this.height) {
      target.width = this.width;
      target.height = this.height;
    }
    const context = target.getContext("2d");
    if (target.picture?.width !== this.width || target.picture?.height !== this.height)
      target.picture = context.createImageData(this.width, this.height);
    fill(new Uint32Array(target.picture.data.buffer));
    context.putImageData(target.picture, 0, 0);
  }

  fill(pixels) {
    const { width, height, values } = this;
    let color;
    if (this.kind === "color") {
      const words = new Uint32Array(values.buffer, values.byteOffset, width * height);
      color = (i) => words[i] | 0xff000000;
    } else if (this.kind === "stencil") {
      this.words ||= Uint32Array.from(this.palette, ([r, g, b]) => 0xff000000 | b << 16 | g << 8 | r);
      color = (i) => this.words[values[i]];
    } else {
      let low = this.farthest, high = 0;
      for (const d of values) if (d !== this.farthest) { if (d < low) low = d; if (d > high) high = d; }
      const span = Math.max(high - low, 1);
      color = (i) => {
        const grey = values[i] === this.farthest ? 0 : Math.floor(255.5 - 215 * (values[i] - low) / span);
        return 0xff000000 | grey << 16 | grey << 8 | grey;
      };
    }
    for (let y = 0, out = 0; y < height; ++y)
      for (let i = (height - 1 - y) * width, end = i + width; i < end; ++i) pixels[out++] = color(i);
  }

  /// color(i): [r, g, b, a] of a pixel, or nothing. note(i): what the layer says of a pixel, in words.
  setOverlay(color, note) {
    this.layers.overlay = color ? { color, note } : null;
    if (color)
      this.paint(this.overlayContent, (pixels) => {
        for (let y = 0, out = 0; y < this.height; ++y)
          for (let i = (this.height - 1 - y) * this.width, end = i + this.width; i < end; ++i) {
            const c = color(i);
            pixels[out++] = c ? (c[3] << 24 | c[2] << 16 | c[1] << 8 | c[0]) >>> 0 : 0;
          }
      });
    this.draw();
  }
  setWires(wires) {
    this.layers.wires = wires;
    this.draw();
  }

  resize() {
    const box = this.canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
    if (width === this.canvas.width && height === this.canvas.height) return;
    const fitted = this.isFitted();
    this.canvas.width = width;
    this.canvas.height = height;
    if (fitted) this.fit(); else this.draw();
  }
  fitScale() { return Math.min(this.canvas.width / this.width, this.canvas.height / this.height); }
  isFitted() { return !this.scale || Math.abs(this.scale - this.fitted) < 1e-9; }
  fit() {
    this.scale = this.fitted = this.fitScale();
    this.left = (this.canvas.width - this.width * this.scale) / 2;
    this.top = (this.canvas.height - this.height * this.scale) / 2;
    this.draw();
  }
  /// About a place of the canvas.
  zoom(factor, x = this.canvas.width / 2, y = this.canvas.height / 2) {
    const least = Math.min(this.fitScale(), 1) / 2, scale = Math.min(Math.max(this.scale * factor, least), 96);
    this.left = x - (x - this.left) * scale / this.scale;
    this.top = y - (y - this.top) * scale / this.scale;
    this.scale = scale;
    this.draw();
  }
  zoomAtCursor(factor) {
    const { x, y } = this.cornerOf(this.cursor.x + 0.5, this.cursor.y + 0.5);
    this.zoom(factor, x, y);
    this.reveal();
  }

  /// Where window coordinates lie on the canvas.
  cornerOf(x, y) { return { x: this.left + x * this.scale, y: this.top + (this.height - y) * this.scale }; }
  pixelAt(event) {
    const box = this.canvas.getBoundingClientRect(), ratio = this.canvas.width / box.width;
    const x = Math.floor(((event.clientX - box.left) * ratio - this.left) / this.scale);
    const row = Math.floor(((event.clientY - box.top) * ratio - this.top) / this.scale);
    return { x, y: this.height - 1 - row, inside: x >= 0 && row >= 0 && x < this.width && row < this.height };
  }
  moveTo(x, y) {
    this.cursor = { x: Math.min(Math.max(x, 0), this.width - 1), y: Math.min(Math.max(y, 0), this.height - 1) };
    this.reveal();
    this.draw();
    this.onMove(this.cursor.x, this.cursor.y);
  }
  /// Pans so that the cursor is seen.
  reveal() {
    const at = this.cornerOf(this.cursor.x, this.cursor.y + 1), margin = Math.min(40, this.canvas.width / 4);
    if (at.x < margin) this.left += margin - at.x;
    if (at.x + this.scale > this.canvas.width - margin) this.left -= at.x + this.scale - this.canvas.width + margin;
    if (at.y < margin) this.top += margin - at.y;
    if (at.y + this.scale > this.canvas.height - margin) this.top -= at.y + this.scale - this.canvas.height + margin;
    if (this.isFitted() && this.scale <= this.fitScale()) {
      this.left = (this.canvas.width - this.width * this.scale) / 2;
      this.top = (this.canvas.height - this.height * this.scale) / 2;
    }
  }
  pick(x, y) {
    this.moveTo(x, y);
    this.picked = { x, y };
    this.draw();
    this.onPick(x, y);
  }

  listen() {
    const { canvas } = this;
    let drag = null;
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      drag = { x: event.clientX, y: event.clientY, left: this.left, top: this.top, moved: false };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!drag) {
        const at = this.pixelAt(event);
        if (at.inside) this.onMove(at.x, at.y);
        return;
      }
      const dx = event.clientX - drag.x, dy = event.clientY - drag.y;
      if (Math.hypot(dx, dy) > 4) drag.moved = true;
      if (!drag.moved) return;
      const ratio = canvas.width / canvas.getBoundingClientRect().width;
      this.left = drag.left + dx * ratio;
      this.top = drag.top + dy * ratio;
      this.draw();
    });
    canvas.addEventListener("pointercancel", () => { drag = null; });
    canvas.addEventListener("pointerup", (event) => {
      if (!drag) return;
      const at = this.pixelAt(event), wasDrag = drag.moved;
      drag = null;
      if (!wasDrag && at.inside) this.pick(at.x, at.y);
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const box = canvas.getBoundingClientRect(), ratio = canvas.width / box.width;
      this.zoom(Math.pow(1.0015, -event.deltaY), (event.clientX - box.left) * ratio, (event.clientY - box.top) * ratio);
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const step = event.shiftKey ? 10 : 1, move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (move) this.moveTo(this.cursor.x + move[0] * step, this.cursor.y + move[1] * step);
      else if (event.key === "Enter" || event.key === " ") this.pick(this.cursor.x, this.cursor.y);
      else if (event.key === "+" || event.key === "=") this.zoomAtCursor(1.5);
      else if (event.key === "-") this.zoomAtCursor(1 / 1.5);
      else if (event.key === "0") this.fit();
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  draw() {
    if (!this.values || this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.drawNow(); });
  }
  drawNow() {
    const { canvas } = this, context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = "#777";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.imageSmoothingEnabled = this.scale < 1;
    const paste = (content) => context.drawImage(content, this.left, this.top, this.width * this.scale, this.height * this.scale);
    paste(this.content);
    if (this.layers.overlay) paste(this.overlayContent);
    if (this.layers.wires) this.drawWires(context);
    if (this.scale >= 14) this.drawNumbers(context);
    this.drawMarks(context);
  }

  drawWires(context) {
    // Mesh, front cap, sides, back cap, silhouette; Okabe and Ito's colours.
    const colors = ["#ffffff", "#e69f00", "#56b4e9", "#cc79a7", "#f0e442"], widths = [1, 1, 1, 1, 2.5];
    const { wires } = this.layers;
    for (const kind of [0, 3, 2, 1, 4]) {
      context.beginPath();
      for (let i = 0; i < wires.length; i += 5) {
        if (wires[i + 4] !== kind) continue;
        const a = this.cornerOf(wires[i] / 256, wires[i + 1] / 256), b = this.cornerOf(wires[i + 2] / 256, wires[i + 3] / 256);
        context.moveTo(a.x, a.y);
        context.lineTo(b.x, b.y);
      }
      context.strokeStyle = colors[kind];
      context.lineWidth = widths[kind];
      context.stroke();
    }
  }

  valueText(x, y) {
    const i = y * this.width + x;
    if (this.kind === "color") return [...this.values.subarray(4 * i, 4 * i + 4)].join(" ");
    return String(this.values[i]);
  }

  drawNumbers(context) {
    if (this.kind === "color" && this.scale < 34) return;
    if (this.kind === "depth" && this.scale < 48) return;
    const first = { x: Math.max(0, Math.floor(-this.left / this.scale)), row: Math.max(0, Math.floor(-this.top / this.scale)) };
    const last = { x: Math.min(this.width, Math.ceil((this.canvas.width - this.left) / this.scale)),
      row: Math.min(this.height, Math.ceil((this.canvas.height - this.top) / this.scale)) };
    context.textAlign = "center";
    context.textBaseline = "middle";
    for (let row = first.row; row < last.row; ++row)
      for (let x = first.x; x < last.x; ++x) {
        const y = this.height - 1 - row, words = this.kind === "color" ? this.valueText(x, y).split(" ").slice(0, 3) : [this.valueText(x, y)];
        const size = Math.min(this.scale * 0.6, this.kind === "color" ? this.scale / 3.4 : 1.6 * this.scale / Math.max(words[0].length, 2));
        const px = this.left + (x + 0.5) * this.scale, py = this.top + (row + 0.5) * this.scale;
        context.font = `${size}px ui-monospace, monospace`;
        context.lineWidth = size / 5;
        context.strokeStyle = "#000a";
        context.fillStyle = "#fff";
        words.forEach((word, i) => {
          const at = py + (i - (words.length - 1) / 2) * size;
          context.strokeText(word, px, at);
          context.fillText(word, px, at);
        });
      }
  }

  drawMarks(context) {
    const frame = (pixel, color) => {
      const at = this.cornerOf(pixel.x, pixel.y + 1), size = Math.max(this.scale, 3);
      context.lineWidth = 3;
      context.strokeStyle = "#000";
      context.strokeRect(at.x - 1, at.y - 1, size + 2, size + 2);
      context.lineWidth = 1.5;
      context.strokeStyle = color;
      context.strokeRect(at.x - 1, at.y - 1, size + 2, size + 2);
    };
    if (document.activeElement === this.canvas) frame(this.cursor, "#fff");
    if (this.picked && this.picked.x < this.width && this.picked.y < this.height) {
      frame(this.picked, "#f0e442");
      if (this.scale < 8) {
        const at = this.cornerOf(this.picked.x + 0.5, this.picked.y + 0.5);
        context.strokeStyle = "#f0e442";
        context.lineWidth = 1.5;
        context.beginPath();
        context.arc(at.x, at.y, 9, 0, 7);
        context.stroke();
      }
    }
  }
}

/// A layer of two counts a pixel: the one blue, the other orange, both violet (Okabe and Ito 2008).
const twoCounts = (up, down, upName, downName) => {
  const blue = [0, 114, 178], orange = [213, 94, 0], violet = [204, 121, 167], shade = (n) => 130 + Math.min(n, 5) * 25;
  return {
    color: (i) => up[i] && down[i] ? [...violet, 220] : up[i] ? [...blue, shade(up[i])] : down[i] ? [...orange, shade(down[i])] : [255, 255, 255, 110],
    note: (i) => `${upName} ${up[i]}, ${downName} ${down[i]}`,
    legend: [[blue, upName], [orange, downName], [violet, "both"]],
  };
};

/// A layer of pixels that have something or not.
const marked = (has, color, name, otherName) => ({
  color: (i) => has(i) ? color : [255, 255, 255, 140],
  note: (i) => has(i) ? name : otherName,
  legend: [[color.slice(0, 3), name]],
});

/// The colours of a layer, and of a stencil buffer each value with its pixels.
const showLegend = (box, view, overlay, palette) => {
  box.replaceChildren();
  const add = (color, text) => {
    const item = document.createElement("span"), chip = document.createElement("span");
    chip.className = "chip";
    chip.style.background = `rgb(${color.join(" ")})`;
    item.append(chip, text);
    box.append(item);
  };
  for (const [color, text] of overlay?.legend || []) add(color, text);
  if (view.kind !== "stencil") return;
  const pixels = new Array(256).fill(0);
  for (const value of view.values) ++pixels[value];
  pixels.forEach((n, value) => { if (n) add(palette[value], `${value}${value >= 230 ? ` (or ${value - 256})` : ""}: ${n} px`); });
};

/// Wires of several draws as those of one.
const joined = (all) => {
  const out = new Int32Array(all.reduce((n, wires) => n + wires.length, 0));
  let at = 0;
  for (const wires of all) { out.set(wires, at); at += wires.length; }
  return out;
};

/// A list that was used with the mouse gives the keys back to the page; one that was used with keys keeps them.
const leaveAfterMouse = () => {
  let byMouse = false;
  document.addEventListener("pointerdown", () => { byMouse = true; }, true);
  document.addEventListener("keydown", () => { byMouse = false; }, true);
  document.addEventListener("change", (event) => { if (byMouse && event.target.matches("select")) event.target.blur(); });
};
