// Choosing another of the poses that were weighed, and turning the model over the photo.
import {Matrix4, Vector3} from 'three';
import {element, picture, slider, button} from './dom.js';
import {rounded} from './fixes.js';
import {eyeOf, inFrame} from './projection.js';

const radians = Math.PI / 180;

function turnAbout(center, axis, degrees) {
  return new Matrix4().makeTranslation(center.x, center.y, center.z)
    .multiply(new Matrix4().makeRotationAxis(axis, degrees * radians))
    .multiply(new Matrix4().makeTranslation(-center.x, -center.y, -center.z));
}

export class PoseTool {
  constructor({fixes, model, data, redraw}) {
    Object.assign(this, {fixes, model, data, redraw});
    this.hint = 'Choose the pose that shows the object as the photo does, or turn the model until it lies about right. ' +
      'Only poses near it are then tried.';
    this.states = new Map();  // by photo: what was chosen
  }

  forget() {
    this.states.clear();
  }

  available(photo) {
    return Boolean(this.model && photo.P);
  }

  state(photo) {
    if (!this.states.has(photo)) this.states.set(photo, {chosen: 0, turn: 0, tilt: 0, roll: 0});
    return this.states.get(photo);
  }

  start(photo) {
    this.photo = photo;
  }

  base() {
    const {chosen} = this.state(this.photo);
    return this.photo.candidates?.[chosen]?.P ?? this.photo.P;
  }

  pose() {
    const {turn, tilt, roll} = this.state(this.photo);
    const P = this.base();
    if (turn === 0 && tilt === 0 && roll === 0) return P;
    const {center, radius} = this.model;
    const {forward, up} = eyeOf(P, radius);
    const right = new Vector3().crossVectors(forward, up).normalize();
    const motion = turnAbout(center, forward, roll)
      .multiply(turnAbout(center, right, tilt))
      .multiply(turnAbout(center, new Vector3(0, 1, 0), turn));
    return inFrame(P, motion);
  }

  keep() {
    const state = this.state(this.photo);
    const unchanged = state.turn === 0 && state.tilt === 0 && state.roll === 0;
    state.set = !(unchanged && state.chosen === 0 && !state.insisted);
    this.fixes.set(this.photo.name, 'camera.initial',
      state.set ? rounded(inFrame(this.pose(), this.data.modelFromInput)) : undefined);
    this.redraw();
  }

  panel() {
    const state = this.state(this.photo);
    const sliders = {};
    const turned = (key) => (value) => {
      state[key] = value;
      this.keep();
    };
    const choose = (index) => {
      Object.assign(state, {chosen: index, turn: 0, tilt: 0, roll: 0, insisted: true});
      for (const each of Object.values(sliders)) each.set(0);
      poses.querySelectorAll('button').forEach((each, i) => each.setAttribute('aria-pressed', String(i === index)));
      this.keep();
    };
    const poses = element('div', {class: 'poses', role: 'group', 'aria-label': 'Candidate poses'});
    const weighed = this.photo.candidates ?? [];
    if (weighed.length > 1) weighed.forEach((candidate, i) => {
      const shown = picture(candidate.picture);
      poses.append(element('button', {
        type: 'button',
        'data-candidate': i,
        'aria-pressed': String(state.set === true && state.chosen === i),
        onclick: () => choose(i),
      }, shown && element('img', {src: shown.src, alt: ''}),
      element('span', {}, `Pose ${i + 1}: ${candidate.overlap_percent.toFixed(1)} %`)));
    });
    const limits = {min: -180, max: 180, value: 0, unit: '°'};
    sliders.turn = slider('Turn about the upright axis', {...limits, value: state.turn}, turned('turn'));
    sliders.tilt = slider('Tilt', {...limits, min: -90, max: 90, value: state.tilt}, turned('tilt'));
    sliders.roll = slider('Roll', {...limits, value: state.roll}, turned('roll'));
    return element('div', {class: 'panel'}, poses, sliders.turn, sliders.tilt, sliders.roll,
      button('As it was', () => {
        Object.assign(state, {insisted: false});
        choose(0);
        state.insisted = false;
        this.keep();
        poses.querySelectorAll('button').forEach((each) => each.setAttribute('aria-pressed', 'false'));
      }));
  }
}
