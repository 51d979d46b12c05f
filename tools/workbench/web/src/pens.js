// SPDX-License-Identifier: GPL-3.0-or-later
// Two ways to draw the same picture: on a canvas, and as an SVG document for a report. Points and strokes by the hundred
// thousand go into the pixels of an image, which is an order of magnitude faster than a call for each.

/** '#rrggbb' or 'rgb(r,g,b)' as a pixel, opaque. */
function pixelOf(colour) {
  let rgb;
  if (colour.startsWith('#')) rgb = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  else
    rgb = colour
      .match(/[\d.]+/g)
      .slice(0, 3)
      .map(Number);
  return (0xff000000 | (rgb[2] << 16) | (rgb[1] << 8) | rgb[0]) >>> 0;
}

export class CanvasPen {
  constructor(canvas, width, height) {
    this.ratio = globalThis.devicePixelRatio || 1;
    this.width = width;
    this.height = height;
    const [w, h] = [Math.max(1, Math.round(width * this.ratio)), Math.max(1, Math.round(height * this.ratio))];
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    this.context = canvas.getContext('2d');
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.context.clearRect(0, 0, width, height);
  }
  rect(x, y, w, h, fill, stroke = null, opacity = 1) {
    const c = this.context;
    c.globalAlpha = opacity;
    if (fill) {
      c.fillStyle = fill;
      c.fillRect(x, y, w, h);
    }
    c.globalAlpha = 1;
    if (stroke) {
      c.strokeStyle = stroke;
      c.lineWidth = 1;
      c.strokeRect(x + 0.5, y + 0.5, w - 1, h - 1);
    }
  }
  /** points: [x0, y0, x1, y1 ...]; NaN breaks the line. */
  line(points, colour, width = 1) {
    const c = this.context;
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.beginPath();
    let open = false;
    for (let i = 0; i + 1 < points.length; i += 2) {
      if (Number.isNaN(points[i + 1]) || Number.isNaN(points[i])) {
        open = false;
        continue;
      }
      if (open) c.lineTo(points[i], points[i + 1]);
      else c.moveTo(points[i], points[i + 1]);
      open = true;
    }
    c.stroke();
  }
  text(x, y, words, { colour, align = 'left', size = 11, turn = 0, bold = false }) {
    const c = this.context;
    c.save();
    c.translate(x, y);
    c.rotate(turn);
    c.font = `${bold ? '600 ' : ''}${size}px system-ui, "DejaVu Sans", sans-serif`;
    c.fillStyle = colour;
    c.textAlign = align;
    c.textBaseline = 'middle';
    c.fillText(words, 0, 0);
    c.restore();
  }
  image(area, paint) {
    const r = this.ratio;
    const [x, y] = [Math.round(area.x * r), Math.round(area.y * r)];
    const [w, h] = [Math.max(1, Math.round(area.w * r)), Math.max(1, Math.round(area.h * r))];
    const off = new OffscreenCanvas(w, h);
    const context = off.getContext('2d');
    const image = context.createImageData(w, h);
    paint(new Uint32Array(image.data.buffer), w, h, r, x, y);
    context.putImageData(image, 0, 0);
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.drawImage(off, x, y);
    this.context.setTransform(r, 0, 0, r, 0, 0);
  }
  /** Squares of `size` px at (px, py) inside of area {x, y, w, h}; colour[i] is an index of palette, 255 for none. */
  dots(area, px, py, colour, palette, size) {
    this.image(area, (pixels, w, h, r, x0, y0) => {
      const inks = Uint32Array.from(palette, pixelOf);
      const side = Math.max(1, Math.round(size * r)),
        half = side >> 1;
      for (let i = 0; i < px.length; ++i) {
        if (colour[i] === 255) continue;
        const x = Math.round(px[i] * r) - x0 - half,
          y = Math.round(py[i] * r) - y0 - half;
        if (!(x >= 0 && y >= 0 && x + side <= w && y + side <= h)) continue;
        const ink = inks[colour[i]];
        for (let k = 0, at = y * w + x; k < side; ++k, at += w) for (let j = 0; j < side; ++j) pixels[at + j] = ink;
      }
    });
  }
  /** Straight strokes from (ax, ay) to (bx, by), colours as above; every `step`th of them. */
  strokes(area, ax, ay, bx, by, colour, palette, step = 1) {
    this.image(area, (pixels, w, h, r, x0, y0) => {
      const inks = Uint32Array.from(palette, pixelOf);
      for (let i = 0; i < ax.length; i += step) {
        if (colour[i] === 255 || !Number.isFinite(ax[i] + ay[i] + bx[i] + by[i])) continue;
        const x = ax[i] * r - x0,
          y = ay[i] * r - y0,
          dx = bx[i] * r - x0 - x,
          dy = by[i] * r - y0 - y;
        const steps = Math.min(4000, Math.max(1, Math.ceil(Math.max(Math.abs(dx), Math.abs(dy)))));
        const ink = inks[colour[i]];
        for (let k = 0; k <= steps; ++k) {
          const u = Math.round(x + (dx * k) / steps),
            v = Math.round(y + (dy * k) / steps);
          if (u >= 0 && v >= 0 && u < w && v < h) pixels[v * w + u] = ink;
        }
        const u = Math.round(x),
          v = Math.round(y);
        if (u > 0 && v > 0 && u < w - 1 && v < h - 1) pixels[v * w + u + 1] = pixels[(v + 1) * w + u] = ink;
      }
    });
  }
}

const escaped = (text) => String(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
const short = (value) => (Math.round(value * 10) / 10).toString();

export class SvgPen {
  constructor(width, height, paper) {
    this.width = width;
    this.height = height;
    this.parts = [`<rect width="${short(width)}" height="${short(height)}" fill="${escaped(paper)}"/>`];
  }
  rect(x, y, w, h, fill, stroke = null, opacity = 1) {
    this.parts.push(
      `<rect x="${short(x)}" y="${short(y)}" width="${short(Math.max(0, w))}" height="${short(Math.max(0, h))}" fill="${escaped(fill || 'none')}"` +
        `${stroke ? ` stroke="${escaped(stroke)}"` : ''}${opacity < 1 ? ` fill-opacity="${opacity}"` : ''}/>`,
    );
  }
  line(points, colour, width = 1) {
    let path = '',
      open = false;
    for (let i = 0; i + 1 < points.length; i += 2) {
      if (Number.isNaN(points[i + 1]) || Number.isNaN(points[i])) {
        open = false;
        continue;
      }
      path += `${open ? 'L' : 'M'}${short(points[i])} ${short(points[i + 1])}`;
      open = true;
    }
    this.parts.push(`<path d="${path}" fill="none" stroke="${escaped(colour)}" stroke-width="${width}"/>`);
  }
  text(x, y, words, { colour, align = 'left', size = 11, turn = 0, bold = false }) {
    const anchor = { left: 'start', center: 'middle', right: 'end' }[align];
    this.parts.push(
      `<text transform="translate(${short(x)} ${short(y)}) rotate(${short((turn * 180) / Math.PI)})" dy="0.35em" font-family="sans-serif" ` +
        `font-size="${size}"${bold ? ' font-weight="600"' : ''} fill="${escaped(colour)}" text-anchor="${anchor}">${escaped(words)}</text>`,
    );
  }
  dots(area, px, py, colour, palette, size) {
    const paths = palette.map(() => []);
    for (let i = 0; i < px.length; ++i) {
      if (colour[i] === 255 || !(px[i] >= area.x && px[i] <= area.x + area.w && py[i] >= area.y && py[i] <= area.y + area.h)) continue;
      paths[colour[i]].push(`M${short(px[i])} ${short(py[i])}h0`);
    }
    this.push(paths, palette, size);
  }
  strokes(area, ax, ay, bx, by, colour, palette) {
    const paths = palette.map(() => []);
    for (let i = 0; i < ax.length; ++i) {
      if (colour[i] === 255 || !Number.isFinite(ax[i] + ay[i] + bx[i] + by[i])) continue;
      paths[colour[i]].push(`M${short(ax[i])} ${short(ay[i])}L${short(bx[i])} ${short(by[i])}`);
    }
    this.push(paths, palette, 1);
  }
  push(paths, palette, width) {
    paths.forEach((list, k) => {
      if (list.length)
        this.parts.push(
          `<path d="${list.join('')}" fill="none" stroke-linecap="round" stroke-width="${width}" stroke="${escaped(palette[k])}"/>`,
        );
    });
  }
  toString() {
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${short(this.width)}" height="${short(this.height)}" viewBox="0 0 ${short(this.width)} ${short(this.height)}">${this.parts.join('')}</svg>`;
  }
}
