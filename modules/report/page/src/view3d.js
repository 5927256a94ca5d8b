// The view of the model that turns: mouse, touch and keyboard.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {button, choice, element, slider} from './dom.js';
import {eyeOf} from './projection.js';
import {grownColor, unseenColor} from './model.js';

const radians = Math.PI / 180;

function css(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function hex(color) {
  return '#' + color.toString(16).padStart(6, '0');
}

/** Nothing where the browser has no WebGL. */
export function makeRenderer(canvas, options = {}) {
  try {
    const renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true, ...options});
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    return renderer;
  } catch {
    return null;
  }
}

export class OrbitView {
  constructor(canvas, model) {
    this.canvas = canvas;
    this.model = model;
    this.renderer = makeRenderer(canvas);
    if (!this.renderer) return;
    this.scene = new THREE.Scene();
    this.holder = new THREE.Group();
    this.scene.add(this.holder);
    this.camera = new THREE.PerspectiveCamera(32, 1, model.radius / 50, model.radius * 50);
    this.sky = new THREE.HemisphereLight(0xffffff, 0x8d8a84, 1.1);
    this.sun = new THREE.DirectionalLight(0xffffff, 2.2);
    this.scene.add(this.sky, this.sun);
    this.light = {azimuth: -35, elevation: 40, intensity: 100};
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.minDistance = 0.3 * model.radius;
    this.controls.maxDistance = 30 * model.radius;
    this.controls.addEventListener('change', () => this.draw());
    canvas.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.fit()).observe(canvas.parentElement);
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
    this.home();
    this.fit();
  }

  /** From the front, a little from above; or as the photo with this camera saw it. */
  home(P = null) {
    const {center, radius} = this.model;
    if (P) {
      const {eye, up} = eyeOf(P, radius);
      const away = eye.clone().sub(center);
      this.camera.up.set(0, 1, 0);
      // A photo that was taken from straight above has no use for the upright axis.
      if (Math.abs(away.clone().normalize().y) > 0.985) this.camera.up.copy(up);
      away.setLength(3.2 * radius);
      this.camera.position.copy(center).add(away);
    } else {
      this.camera.up.set(0, 1, 0);
      this.camera.position.copy(center).add(new THREE.Vector3(0.55, 0.42, 1).setLength(3.2 * radius));
    }
    this.controls.target.copy(center);
    this.controls.update();
    this.draw();
  }

  fit() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // Narrow windows see as much across as wide ones see upwards.
    this.camera.fov = width < height ? 2 * Math.atan(Math.tan(16 * radians) * height / width) / radians : 32;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  key(event) {
    const turn = {ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, -8], ArrowDown: [0, 8]}[event.key];
    if (turn && event.shiftKey) this.pan(turn[0] / 160, -turn[1] / 160);
    else if (turn) this.turn(turn[0] * radians, turn[1] * radians);
    else if (event.key === '+' || event.key === '=') this.zoom(1 / 1.15);
    else if (event.key === '-') this.zoom(1.15);
    else if (event.key === 'Home' || event.key === '0') this.home(this.first);
    else return;
    event.preventDefault();
  }

  turn(azimuth, elevation) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const upright = new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0));
    const ball = new THREE.Spherical().setFromVector3(away.applyQuaternion(upright));
    ball.theta += azimuth;
    ball.phi += elevation;
    ball.makeSafe();
    away.setFromSpherical(ball).applyQuaternion(upright.invert());
    this.camera.position.copy(this.controls.target).add(away);
    this.controls.update();
    this.draw();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  pan(right, up) {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const step = new THREE.Vector3(right * distance, up * distance, 0).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(step);
    this.controls.target.add(step);
    this.controls.update();
    this.draw();
  }

  /** The place on the model under a point of the canvas, in the model's frame; nothing beside it. */
  pick(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(
      2 * (clientX - box.left) / box.width - 1, 1 - 2 * (clientY - box.top) / box.height);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.camera);
    const hit = ray.intersectObject(this.model.scene, true)[0];
    return hit ? hit.point : null;
  }

  draw() {
    if (!this.renderer) return;
    // The light stands still beside the viewer: turning the model shows its relief.
    const {azimuth, elevation, intensity} = this.light;
    const flat = Math.cos(elevation * radians);
    const from = new THREE.Vector3(
      Math.sin(azimuth * radians) * flat, Math.sin(elevation * radians), Math.cos(azimuth * radians) * flat);
    this.sun.position.copy(from.applyQuaternion(this.camera.quaternion)).add(this.model.center);
    this.sun.target.position.copy(this.model.center);
    this.sun.target.updateMatrixWorld();
    this.sun.intensity = 2.4 * intensity / 100;
    this.sky.intensity = 0.4 + 0.7 * intensity / 100;
    this.renderer.setClearColor(new THREE.Color(css('--stage')));
    this.holder.add(this.model.scene);  // another view may have taken it
    this.model.show(this.mode ?? 'photo', this.wireframe ?? false);
    this.renderer.render(this.scene, this.camera);
  }
}

function legend(model, mode, data) {
  const rows = [];
  const entry = (color, text) =>
    rows.push(element('li', {}, element('span', {class: 'chip', style: `background:${color}`}), text));
  if (mode !== 'coverage') return rows;
  for (const surface of model.surfaces)
    if (surface.kind === 'seen') entry(hex(surface.color), data.material_names?.[surface.name] ?? surface.name);
  if (model.surfaces.some(({kind}) => kind === 'grown'))
    entry(hex(grownColor), 'grown: beside what a photo shows, in its colours');
  if (model.surfaces.some(({kind}) => kind === 'unseen' || kind === 'surface'))
    entry(hex(unseenColor), data.unseen_text ?? 'no photo shows this');
  return rows;
}

/** Fills the card of the 3D view. Returns the view, or nothing without WebGL. */
export function startView(root, model, data) {
  const canvas = element('canvas', {
    id: 'model-canvas',
    tabindex: 0,
    'aria-label': 'The model in three dimensions. Arrow keys turn it, with Shift they move it, plus and minus zoom, Home resets.',
  });
  const stage = element('div', {class: 'stage'}, canvas);
  const view = new OrbitView(canvas, model);
  if (!view.renderer) return null;
  const cameras = data.photos.filter((photo) => photo.P);
  view.first = cameras.length > 0 ? cameras[0].P : null;
  view.home(view.first);
  const key = element('ul', {class: 'legend'});
  const lights = element('div', {class: 'lights'},
    slider('Light azimuth', {min: -180, max: 180, value: view.light.azimuth, unit: '°'}, (value) => {
      view.light.azimuth = value;
      view.draw();
    }),
    slider('Light elevation', {min: -90, max: 90, value: view.light.elevation, unit: '°'}, (value) => {
      view.light.elevation = value;
      view.draw();
    }),
    slider('Light strength', {min: 0, max: 250, value: view.light.intensity, unit: ' %'}, (value) => {
      view.light.intensity = value;
      view.draw();
    }));
  const show = (mode) => {
    view.mode = mode;
    lights.hidden = mode === 'photo' || mode === 'texels';
    key.replaceChildren(...legend(model, mode, data));
    view.draw();
  };
  const painted = model.surfaces.some(({kind}) => kind === 'seen');
  const modes = painted
    ? [['photo', 'Unlit', 'The photo’s own light, and none besides'], ['lit', 'Lit', 'Colours under a lamp'],
      ['shape', 'Shape', 'Without colours'], ['coverage', 'Coverage', 'Which photo painted what']]
    : [['shape', 'Shape', 'Without colours'], ['lit', 'Lit', 'Colours under a lamp'], ['photo', 'Unlit', 'Colours alone']];
  if (model.surfaces.some(({materials}) => materials.texels !== materials.coverage))
    modes.push(['texels', 'Texels', 'Which photo each pixel of the atlas is from; orange: grown']);
  const wire = element('button', {
    type: 'button',
    class: 'toggle',
    'aria-pressed': 'false',
    title: 'The triangles of the light copy on this page',
    onclick: () => {
      view.wireframe = !view.wireframe;
      wire.setAttribute('aria-pressed', String(view.wireframe));
      view.draw();
    },
  }, 'Wireframe');
  const places = element('div', {class: 'choice', role: 'group', 'aria-label': 'View from'});
  cameras.slice(0, 6).forEach((photo, i) => places.append(button(
    cameras.length === 1 ? 'As the photo' : `Photo ${i + 1}`, () => view.home(photo.P), {title: photo.name})));
  places.append(button('Front', () => view.home()));
  places.append(button('Back', () => {
    view.home();
    view.turn(Math.PI, 0);
  }));
  places.append(button('Above', () => {
    view.home();
    view.turn(0, -Math.PI / 2.6);
  }));
  root.replaceChildren(
    stage,
    element('div', {class: 'tools'}, choice('Surface', modes, modes[0][0], show), wire, places),
    lights, key,
    element('p', {class: 'meta'},
      'Drag to turn, wheel or pinch to zoom, right button or two fingers to move; or arrow keys, Shift and arrow keys, plus, minus, Home. ' +
      `Shown with ${Math.round(model.triangles).toLocaleString('en')} triangles and JPEG textures; model.glb is the finished model.`));
  show(modes[0][0]);
  view.fit();
  return view;
}
