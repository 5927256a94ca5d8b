// The page of a run: the view in three dimensions, and mending.
import {Matrix4} from 'three';
import {load, Model} from './model.js';
import {startMending} from './mend.js';
import {inFrame} from './projection.js';
import {startView} from './view3d.js';

/** From the model's frame to the input's: page = turn * (metres * input) - origin, by the file's own extras. */
function inputFromPage(data, gltf) {
  const origin = gltf.scene.userData.origin_m ?? [0, 0, 0];
  const m = data.metres_per_unit;
  const [r00, r01, r02, r10, r11, r12, r20, r21, r22] = data.y_up_from_input.map((value) => value * m);
  return new Matrix4().set(
    r00, r01, r02, -origin[0], r10, r11, r12, -origin[1], r20, r21, r22, -origin[2], 0, 0, 0, 1).invert();
}

/** Every camera in the model's frame, as `P`; what the fixes hold stays in the input's. */
function placeCameras(data, inputFromModel) {
  for (const photo of data.photos) {
    if (photo.P_input) photo.P = inFrame(photo.P_input, inputFromModel);
    for (const candidate of photo.candidates ?? []) candidate.P = inFrame(candidate.P_input, inputFromModel);
  }
}

function say(root, text, kind) {
  root.replaceChildren(Object.assign(document.createElement('p'), {className: 'note', textContent: text}));
  document.documentElement.dataset.view = kind;
}

/** Returns the model, or nothing where it cannot be shown. */
async function showModel(root, data) {
  const gltf = await load('model-bytes');
  const model = new Model(gltf);
  data.inputFromModel = inputFromPage(data, gltf);
  data.modelFromInput = data.inputFromModel.clone().invert();
  placeCameras(data, data.inputFromModel);
  if (!startView(root, model, data)) {
    say(root, 'This browser shows no WebGL, so the model cannot be turned here. The pictures below show it from all sides.', 'none');
    return null;
  }
  document.documentElement.dataset.view = 'drawn';
  document.documentElement.dataset.drawnMs = String(Math.round(performance.now()));
  return model;
}

async function start() {
  const data = JSON.parse(document.getElementById('page-data').textContent);
  const root = document.getElementById('view');
  let model = null;
  try {
    if (root) model = await showModel(root, data);
  } catch (error) {
    console.error(error);
    say(root, `The model could not be shown: ${error.message}`, 'failed');
  }
  const mend = document.getElementById('mend');
  if (mend && data.photos.length > 0) startMending(mend, model, data);
}

start();
