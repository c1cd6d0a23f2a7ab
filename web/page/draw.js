// Three dimensions on a canvas, without a library: few lines suffice for a box, an ellipsoid and curves.

export const rotate = ([x, y, z, w], [a, b, c]) => {
  const u = 2 * (y * c - z * b), v = 2 * (z * a - x * c), t = 2 * (x * b - y * a);
  return [a + w * u + y * t - z * v, b + w * v + z * u - x * t, c + w * t + x * v - y * u];
};

const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export class View {
  constructor(canvas) {
    this.canvas = canvas, this.pen = canvas.getContext("2d");
    this.azimuth = 0.6, this.height = 0.35, this.scale = 1;
    canvas.addEventListener("keydown", event => {
      const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
      if (!turn) return;
      this.turn(...turn), event.preventDefault();
    });
  }
  turn(azimuth, height) {
    this.azimuth += azimuth, this.height = Math.max(-1.5, Math.min(1.5, this.height + height));
  }
  /// Screen x, y and depth of a point; z is up.
  project([x, y, z]) {
    const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth), ch = Math.cos(this.height), sh = Math.sin(this.height);
    const right = ca * y - sa * x, away = ca * x + sa * y;
    const unit = 0.42 * this.canvas.height / this.scale;
    return [this.canvas.width / 2 + unit * right, this.canvas.height / 2 - unit * (ch * z - sh * away),
            ch * away + sh * z];
  }
  clear() { this.pen.clearRect(0, 0, this.canvas.width, this.canvas.height); }
  line(points, color, width = 2) {
    const pen = this.pen;
    pen.beginPath();
    points.forEach((p, i) => { const [x, y] = this.project(p); i ? pen.lineTo(x, y) : pen.moveTo(x, y); });
    pen.strokeStyle = css(color) || color, pen.lineWidth = width, pen.stroke();
  }
  dot(point, color, size = 6) {
    const [x, y] = this.project(point);
    this.pen.beginPath(), this.pen.arc(x, y, size, 0, 7), this.pen.fillStyle = css(color) || color, this.pen.fill();
  }
  /// A box with half sides h, turned by q and moved; filled, or as an outline.
  box(h, q, shift, fills, outline) {
    const faces = [];
    for (let axis = 0; axis < 3; ++axis) for (const side of [-1, 1]) {
      const u = (axis + 1) % 3, v = (axis + 2) % 3;
      const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([s, t]) => {
        const p = [0, 0, 0];
        p[axis] = side * h[axis], p[u] = s * h[u], p[v] = t * h[v];
        return rotate(q, p.map((x, i) => x + shift[i]));
      });
      const middle = [0, 1, 2].map(i => corners.reduce((sum, p) => sum + p[i], 0) / 4);
      faces.push({ corners, depth: this.project(middle)[2], color: fills?.[2 * axis + (side > 0)] });
    }
    faces.sort((a, b) => a.depth - b.depth);
    for (const { corners, color } of faces) {
      const pen = this.pen;
      pen.beginPath();
      corners.forEach((p, i) => { const [x, y] = this.project(p); i ? pen.lineTo(x, y) : pen.moveTo(x, y); });
      pen.closePath();
      if (fills) pen.fillStyle = color, pen.fill();
      pen.strokeStyle = css(outline) || outline, pen.lineWidth = fills ? 1 : 2, pen.stroke();
    }
  }
}

/// Curves of errors against time, both axes labelled; the error's axis is logarithmic. The canvas gets the pixels that
/// it has on the screen, so letters have their size on a phone too.
export function drawErrors(canvas, end, curves) {
  const ratio = globalThis.devicePixelRatio || 1, wide = canvas.clientWidth || 960, tall = Math.max(280, wide / 3);
  canvas.width = Math.round(wide * ratio), canvas.height = Math.round(tall * ratio);
  const pen = canvas.getContext("2d"), letter = 13, left = 46, right = 96, top = 24, bottom = 26;
  const width = wide - left - right, height = tall - top - bottom, low = -14, high = 1;
  const x = t => left + width * t / end;
  const y = e => top + height * (high - Math.max(low, Math.log10(e))) / (high - low);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0), pen.clearRect(0, 0, wide, tall);
  pen.font = `${letter}px system-ui, sans-serif`, pen.fillStyle = css("--faint"), pen.strokeStyle = css("--line"), pen.lineWidth = 1;
  for (let p = low + 2; p <= 0; p += 4) {
    pen.beginPath(), pen.moveTo(left, y(10 ** p)), pen.lineTo(left + width, y(10 ** p)), pen.stroke();
    pen.textAlign = "right", pen.fillText(`1e${p}`, left - 6, y(10 ** p) + 4);
  }
  pen.textAlign = "center";
  for (let k = 0; k <= 4; ++k) pen.fillText(`${+(end * k / 4).toPrecision(3)} s`, x(end * k / 4), tall - 8);
  pen.textAlign = "left", pen.fillText("rad", 8, 15);
  const ends = [];
  for (const { name, t, error, chosen } of curves) {
    pen.beginPath();
    let last = 0;
    t.forEach((time, i) => { if (error[i] > 0) { pen.lineTo(x(time), y(error[i])); last = y(error[i]); } });
    pen.strokeStyle = chosen ? css("--other") : css("--faint"), pen.lineWidth = chosen ? 3 : 1.2, pen.stroke();
    if (last) ends.push({ name, at: last, chosen });
  }
  // A name stands where its curve ends, or as near as the names beside it let it.
  ends.sort((a, b) => a.at - b.at);
  const places = ends.map(({ at }) => at), apart = letter + 1;
  for (let round = 0; round < 60; ++round) for (let i = 1; i < places.length; ++i) {
    const lacking = apart - (places[i] - places[i - 1]);
    if (lacking > 0) places[i] += lacking / 2, places[i - 1] = Math.max(top, places[i - 1] - lacking / 2);
  }
  ends.forEach(({ name, at, chosen }, i) => {
    pen.beginPath(), pen.moveTo(left + width, at), pen.lineTo(left + width + 12, places[i]);
    pen.strokeStyle = css("--line"), pen.lineWidth = 1, pen.stroke();
    pen.fillStyle = chosen ? css("--other") : css("--faint"), pen.fillText(name, left + width + 15, places[i] + 4);
  });
}
