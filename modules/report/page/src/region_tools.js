// What the photo shows: a box, a point on the object, strokes, segments.
import {button, choice, element, picture, slider} from './dom.js';
import {pixels} from './fixes.js';
import {mark} from './pad.js';

const objectColor = '#ffffff';
const backgroundColor = '#101418';

export class BoxTool {
  constructor({fixes, redraw}) {
    Object.assign(this, {fixes, redraw});
    this.hint = 'Draw a box round the whole object, with a little room.';
  }

  available(photo) {
    return photo.regions;
  }

  start(photo) {
    this.photo = photo;
    this.box = this.fixes.of(photo.name).box_px;
  }

  down(at) {
    this.from = at;
  }

  move(at) {
    this.box = pixels([
      Math.min(at[0], this.from[0]), Math.min(at[1], this.from[1]),
      Math.abs(at[0] - this.from[0]), Math.abs(at[1] - this.from[1]),
    ]);
  }

  up() {
    if (!this.box || this.box[2] < 2 || this.box[3] < 2) this.box = undefined;
    this.fixes.set(this.photo.name, 'box_px', this.box);
  }

  draw(context, pixel) {
    if (!this.box) return;
    for (const [color, width] of [['#000', 4], ['#ffb000', 2]]) {
      context.strokeStyle = color;
      context.lineWidth = width * pixel;
      context.strokeRect(...this.box);
    }
  }

  panel() {
    return element('div', {class: 'panel'}, button('No box', () => {
      this.box = undefined;
      this.fixes.set(this.photo.name, 'box_px', undefined);
      this.redraw();
    }));
  }
}

export class ClickTool {
  constructor({fixes, redraw}) {
    Object.assign(this, {fixes, redraw});
    this.hint = 'Click a point well inside the object.';
  }

  available(photo) {
    return photo.regions;
  }

  start(photo) {
    this.photo = photo;
  }

  down(at) {
    this.fixes.set(this.photo.name, 'click_px', pixels(at));
  }

  draw(context, pixel) {
    const click = this.fixes.of(this.photo.name).click_px;
    if (click) mark(context, click, '', pixel, '#d1495b');
  }

  panel() {
    return element('div', {class: 'panel'}, button('No point', () => {
      this.fixes.set(this.photo.name, 'click_px', undefined);
      this.redraw();
    }));
  }
}

/** Every corner of a drawn line that matters at this tolerance (Douglas and Peucker 1973). */
function simplified(points, tolerance) {
  if (points.length < 3) return points;
  const [a, b] = [points[0], points.at(-1)];
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  let [farthest, most] = [0, -1];
  for (let i = 1; i + 1 < points.length; ++i) {
    const [x, y] = points[i];
    const distance = length > 0
      ? Math.abs((b[0] - a[0]) * (a[1] - y) - (a[0] - x) * (b[1] - a[1])) / length
      : Math.hypot(x - a[0], y - a[1]);
    if (distance > most) [farthest, most] = [i, distance];
  }
  if (most <= tolerance) return [a, b];
  return [...simplified(points.slice(0, farthest + 1), tolerance).slice(0, -1), ...simplified(points.slice(farthest), tolerance)];
}

export class StrokesTool {
  constructor({fixes, redraw}) {
    Object.assign(this, {fixes, redraw});
    this.hint = 'Draw strokes over what is object and over what is background: one of each at least, a few are enough.';
    this.kind = 'object';
    this.share = 1.2;
    this.drawn = new Map();  // by photo
  }

  available(photo) {
    return photo.regions;
  }

  start(photo) {
    this.photo = photo;
    this.width = this.share / 100 * Math.max(photo.width, photo.height);
    if (!this.drawn.has(photo)) this.drawn.set(photo, []);
  }

  strokes() {
    return this.drawn.get(this.photo);
  }

  forget() {
    this.drawn.clear();
  }

  // Those of one kind alone say too little.
  keep() {
    const both = new Set(this.strokes().map((stroke) => stroke.is)).size === 2;
    this.fixes.set(this.photo.name, 'strokes', both ? [...this.strokes()] : undefined);
    this.redraw();
  }

  down(at) {
    this.line = [at];
  }

  move(at) {
    this.line.push(at);
  }

  up() {
    const line = simplified(this.line, this.width / 8);
    this.line = null;
    this.strokes().push({is: this.kind, width_px: pixels([this.width])[0], points_px: pixels(line.flat())});
    this.keep();
  }

  draw(context, pixel) {
    const shown = this.strokes().map((stroke) => [stroke.is, stroke.width_px, stroke.points_px]);
    if (this.line) shown.push([this.kind, this.width, this.line.flat()]);
    context.lineCap = context.lineJoin = 'round';
    for (const [kind, width, points] of shown)
      for (const rim of [true, false]) {
        context.strokeStyle = (kind === 'object') === rim ? backgroundColor : objectColor;
        context.lineWidth = width + (rim ? 3 * pixel : 0);
        context.beginPath();
        for (let i = 0; i + 1 < points.length; i += 2) context.lineTo(points[i], points[i + 1]);
        if (points.length === 2) context.lineTo(points[0] + 0.01, points[1]);
        context.stroke();
      }
  }

  panel() {
    return element('div', {class: 'panel'},
      choice('Strokes are', [['object', 'Object (white)'], ['background', 'Background (black)']], this.kind,
        (kind) => (this.kind = kind)),
      slider('Width', {min: 0.3, max: 6, step: 0.1, value: this.share, unit: ' %'}, (value) => {
        this.share = value;
        this.width = value / 100 * Math.max(this.photo.width, this.photo.height);
      }),
      button('Take the last one back', () => {
        this.strokes().pop();
        this.keep();
      }));
  }
}

export class SegmentsTool {
  constructor({fixes, redraw}) {
    Object.assign(this, {fixes, redraw});
    this.hint = 'Click the segments that are the object, on and off.';
    this.pictures = new Map();
  }

  available(photo) {
    return photo.regions && photo.segments.length > 1;
  }

  start(photo) {
    this.photo = photo;
    this.chosen = new Set(this.fixes.of(photo.name).segments ??
      photo.segments.filter(({chosen}) => chosen).map(({label}) => label));
    if (!this.pictures.has(photo)) this.pictures.set(photo, null);
    const image = picture(photo.segments_picture);
    image?.decode().then(() => {
      this.read(photo, image);
      this.redraw();
    }, () => {});
  }

  // Segments by their colour in the picture; each is known by a pixel well inside.
  read(photo, image) {
    if (this.pictures.get(photo)) return;
    const canvas = element('canvas', {width: image.naturalWidth, height: image.naturalHeight});
    const context = canvas.getContext('2d', {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    const {data, width, height} = context.getImageData(0, 0, canvas.width, canvas.height);
    const colorAt = (x, y) => {
      const i = 4 * (Math.min(Math.floor(y * height / photo.height), height - 1) * width +
        Math.min(Math.floor(x * width / photo.width), width - 1));
      return data[i] << 16 | data[i + 1] << 8 | data[i + 2];
    };
    const labels = new Map(photo.segments.map(({label, inside_px: [x, y]}) => [colorAt(x, y), label]));
    this.pictures.set(photo, {colorAt, labels, data, width, height});
  }

  down(at) {
    const map = this.pictures.get(this.photo);
    const label = map?.labels.get(map.colorAt(...at));
    if (label === undefined) return;
    if (!this.chosen.delete(label)) this.chosen.add(label);
    this.fixes.set(this.photo.name, 'segments', this.chosen.size > 0 ? [...this.chosen].sort((a, b) => a - b) : undefined);
    this.paint(map);
  }

  // Dims what is not chosen.
  paint(map) {
    const canvas = element('canvas', {width: map.width, height: map.height});
    const context = canvas.getContext('2d');
    const shade = context.createImageData(map.width, map.height);
    for (let i = 0; i < shade.data.length; i += 4) {
      const label = map.labels.get(map.data[i] << 16 | map.data[i + 1] << 8 | map.data[i + 2]);
      if (this.chosen.has(label)) shade.data.set([46, 196, 120, 120], i);
      else shade.data.set([map.data[i] / 3, map.data[i + 1] / 3, map.data[i + 2] / 3, 170], i);
    }
    context.putImageData(shade, 0, 0);
    map.shade = canvas;
  }

  draw(context) {
    const map = this.pictures.get(this.photo);
    if (!map) return;
    if (!map.shade || this.painted !== this.chosen) this.paint(map);
    this.painted = this.chosen;
    context.imageSmoothingEnabled = false;
    context.drawImage(map.shade, 0, 0, this.photo.width, this.photo.height);
  }

  panel() {
    return element('div', {class: 'panel'}, button('As they were', () => {
      this.fixes.set(this.photo.name, 'segments', undefined);
      this.start(this.photo);
      this.redraw();
    }));
  }
}
