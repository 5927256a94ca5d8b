// A photo to point and draw on, by mouse, finger or keyboard. All places are upright pixels of the photo.
import {element, picture} from './dom.js';

export class PhotoPad {
  /** `overlay` draws the model over the photo: overlay(P, width, height) gives a canvas, or nothing. */
  constructor(overlay) {
    this.overlay = overlay;
    this.canvas = element('canvas', {
      class: 'pad',
      tabindex: 0,
      role: 'img',
      'aria-label': 'The photo. Arrow keys move a cross, with Shift in small steps; Enter sets a point or begins and ends a line.',
    });
    this.cursor = null;
    this.pressed = false;
    this.tool = {};
    for (const type of ['pointerdown', 'pointermove', 'pointerup', 'pointercancel'])
      this.canvas.addEventListener(type, (event) => this.pointer(event));
    this.canvas.addEventListener('keydown', (event) => this.key(event));
    this.canvas.addEventListener('blur', () => {
      this.cursor = null;
      this.draw();
    });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  show(photo, tool) {
    this.photo = photo;
    this.tool = tool;
    this.pressed = false;
    const image = picture(photo.picture);
    image?.decode().then(() => this.draw(), () => {});
    this.image = image;
    this.canvas.style.aspectRatio = `${photo.width} / ${photo.height}`;
    this.draw();
  }

  place(event) {
    const box = this.canvas.getBoundingClientRect();
    const clamp = (value, most) => Math.min(Math.max(value, 0), most);
    return [
      clamp((event.clientX - box.left) / box.width * this.photo.width, this.photo.width),
      clamp((event.clientY - box.top) / box.height * this.photo.height, this.photo.height),
    ];
  }

  pointer(event) {
    const at = this.place(event);
    if (event.type === 'pointerdown' && event.button === 0) {
      this.canvas.setPointerCapture(event.pointerId);
      this.pressed = true;
      this.tool.down?.(at);
    } else if (event.type === 'pointermove' && this.pressed) {
      this.tool.move?.(at);
    } else if (event.type !== 'pointermove' && this.pressed) {
      this.pressed = false;
      this.tool.up?.(at);
    } else {
      return;
    }
    this.draw();
  }

  key(event) {
    const direction = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    this.cursor ??= [this.photo.width / 2, this.photo.height / 2];
    if (direction) {
      const step = Math.max(this.photo.width, this.photo.height) * (event.shiftKey ? 0.002 : 0.02);
      this.cursor = [
        Math.min(Math.max(this.cursor[0] + step * direction[0], 0), this.photo.width),
        Math.min(Math.max(this.cursor[1] + step * direction[1], 0), this.photo.height),
      ];
      if (this.pressed) this.tool.move?.(this.cursor);
    } else if (event.key === 'Enter' || event.key === ' ') {
      this.pressed = !this.pressed;
      if (this.pressed) this.tool.down?.(this.cursor);
      // A point is set at once; a box or a line ends with the second press.
      if (!this.pressed || !this.tool.move) {
        this.pressed = false;
        this.tool.up?.(this.cursor);
      }
    } else {
      return;
    }
    event.preventDefault();
    this.draw();
  }

  draw() {
    const {canvas, photo} = this;
    if (!photo || canvas.clientWidth === 0) return;
    const density = Math.min(window.devicePixelRatio, 2);
    canvas.width = Math.round(canvas.clientWidth * density);
    canvas.height = Math.round(canvas.width * photo.height / photo.width);
    const context = canvas.getContext('2d');
    if (this.image?.complete) context.drawImage(this.image, 0, 0, canvas.width, canvas.height);
    const P = this.tool.pose?.();
    const model = P && this.overlay(P, photo, canvas.width, canvas.height);
    if (model) {
      context.globalAlpha = 0.68;
      context.drawImage(model, 0, 0, canvas.width, canvas.height);
      context.globalAlpha = 1;
    }
    // From here on in the photo's pixels, lines as thick as on the screen.
    const scale = canvas.width / photo.width;
    context.setTransform(scale, 0, 0, scale, 0, 0);
    const pixel = density / scale;
    this.tool.draw?.(context, pixel);
    if (this.cursor) cross(context, this.cursor, pixel);
    context.setTransform(1, 0, 0, 1, 0, 0);
  }
}

function cross(context, [x, y], pixel) {
  for (const [color, width] of [['#000', 4], ['#fff', 1.5]]) {
    context.strokeStyle = color;
    context.lineWidth = width * pixel;
    context.beginPath();
    context.moveTo(x - 14 * pixel, y);
    context.lineTo(x + 14 * pixel, y);
    context.moveTo(x, y - 14 * pixel);
    context.lineTo(x, y + 14 * pixel);
    context.stroke();
  }
}

/** A numbered mark. */
export function mark(context, [x, y], label, pixel, color) {
  context.beginPath();
  context.arc(x, y, 9 * pixel, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
  context.lineWidth = 2 * pixel;
  context.strokeStyle = '#fff';
  context.stroke();
  context.beginPath();
  context.arc(x, y, 1.5 * pixel, 0, 2 * Math.PI);
  context.fillStyle = '#fff';
  context.fill();
  context.font = `bold ${13 * pixel}px sans-serif`;
  context.strokeStyle = '#000';
  context.lineWidth = 3 * pixel;
  context.strokeText(label, x + 11 * pixel, y - 8 * pixel);
  context.fillText(label, x + 11 * pixel, y - 8 * pixel);
}
