// Pairs of points: a place on the model and where the photo shows it.
import * as THREE from 'three';
import {button, element} from './dom.js';
import {rounded} from './fixes.js';
import {mark} from './pad.js';
import {OrbitView} from './view3d.js';

const colors = ['#d1495b', '#00798c', '#b8860b', '#6a4c93', '#2e7d32', '#c05000', '#1565c0', '#7b3f00'];
export const leastPairs = 4;

function numberSprite(label, color, size) {
  const canvas = element('canvas', {width: 64, height: 64});
  const context = canvas.getContext('2d');
  mark(context, [24, 40], label, 2, color);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({map, depthTest: false, sizeAttenuation: false}));
  sprite.center.set(24 / 64, 1 - 40 / 64);
  sprite.scale.setScalar(size);
  return sprite;
}

export class PointsTool {
  constructor({fixes, model, data, redraw}) {
    Object.assign(this, {fixes, model, data, redraw});
    this.hint = `Click a place on the model and the same place in the photo, ${leastPairs} times or more, not all on one line: ` +
      'the camera is then searched near where these meet.';
    this.pairs = new Map();  // by photo: [{model: Vector3, photo: [x, y]}]
  }

  forget() {
    this.pairs.clear();
  }

  available() {
    return Boolean(this.model);
  }

  start(photo) {
    this.photo = photo;
    if (!this.pairs.has(photo)) this.pairs.set(photo, []);
  }

  list() {
    return this.pairs.get(this.photo);
  }

  put(side, place) {
    const open = this.list().find((pair) => !pair[side]);
    if (open) open[side] = place;
    else this.list().push({[side]: place});
    this.keep();
  }

  keep() {
    const whole = this.list().filter((pair) => pair.model && pair.photo);
    const rows = whole.map((pair) => [
      ...pair.photo.map((value) => Math.round(value * 10) / 10),
      ...rounded(pair.model.clone().applyMatrix4(this.data.inputFromModel).toArray(), 7),
    ]);
    this.fixes.set(this.photo.name, 'camera.points', whole.length >= leastPairs ? rows.flat() : undefined);
    this.refresh();
    this.redraw();
  }

  down(at) {
    this.put('photo', at);
  }

  draw(context, pixel) {
    this.list().forEach((pair, i) => {
      if (pair.photo) mark(context, pair.photo, String(i + 1), pixel, colors[i % colors.length]);
    });
  }

  panel() {
    // One view for all photos: browsers give out few of them.
    this.stage ??= this.makeStage();
    this.status = element('p', {class: 'meta', role: 'status'});
    requestAnimationFrame(() => {
      this.view.first = this.photo.P ?? null;
      this.view.fit();
      this.view.home(this.view.first);
      this.refresh();
    });
    return element('div', {class: 'panel'}, this.stage, this.status, button('Take the last one back', () => {
      const pair = this.list().at(-1);
      if (pair?.photo && pair.model) delete pair.photo;
      else this.list().pop();
      this.keep();
    }));
  }

  makeStage() {
    const canvas = element('canvas', {
      tabindex: 0,
      class: 'pick',
      'aria-label': 'The model. Click a place on it; arrow keys turn it, Enter takes what is in the middle.',
    });
    const stage = element('div', {class: 'stage small'}, canvas, element('span', {class: 'middle', 'aria-hidden': 'true'}));
    this.view = new OrbitView(canvas, this.model);
    this.marks = new THREE.Group();
    this.view.scene.add(this.marks);
    let pressed = null;
    canvas.addEventListener('pointerdown', (event) => (pressed = [event.clientX, event.clientY]));
    canvas.addEventListener('pointerup', (event) => {
      // Farther than this the model was turned.
      if (pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4)
        this.take(this.view.pick(event.clientX, event.clientY));
    });
    canvas.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter') return;
      const box = canvas.getBoundingClientRect();
      this.take(this.view.pick(box.left + box.width / 2, box.top + box.height / 2));
    });
    return stage;
  }

  refresh() {
    this.marks.clear();
    this.list().forEach((pair, i) => {
      if (!pair.model) return;
      const sprite = numberSprite(String(i + 1), colors[i % colors.length], 0.06);
      sprite.position.copy(pair.model);
      this.marks.add(sprite);
    });
    const whole = this.list().filter((pair) => pair.model && pair.photo).length;
    const open = this.list().find((pair) => !pair.model || !pair.photo);
    this.status.textContent = `${whole} of at least ${leastPairs} pairs` +
      (open ? `; now click the same place ${open.model ? 'in the photo' : 'on the model'}` : '');
    this.view.draw();
  }

  take(place) {
    if (place) this.put('model', place);
  }
}
