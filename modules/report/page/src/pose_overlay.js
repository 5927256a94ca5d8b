// The model as a camera sees it, to be laid over its photo.
import * as THREE from 'three';
import {clipFromModel, eyeOf} from './projection.js';
import {makeRenderer} from './view3d.js';

export class PoseOverlay {
  constructor(model) {
    this.model = model;
    this.canvas = document.createElement('canvas');
    this.renderer = makeRenderer(this.canvas, {alpha: true});
    this.renderer?.setPixelRatio(1);
    this.scene = new THREE.Scene();
    this.material = new THREE.MeshStandardMaterial({color: 0x58b4f0, roughness: 0.8, side: THREE.DoubleSide});
    for (const {node} of model.surfaces) {
      const mesh = new THREE.Mesh(node.geometry, this.material);
      mesh.frustumCulled = false;
      this.scene.add(mesh);
    }
    this.sun = new THREE.DirectionalLight(0xffffff, 2.4);
    this.scene.add(this.sun, new THREE.HemisphereLight(0xffffff, 0x506070, 0.6));
    this.camera = new THREE.Camera();
    this.camera.matrixAutoUpdate = false;
  }

  render(P, photo, width, height) {
    if (!this.renderer) return null;
    this.renderer.setSize(width, height, false);
    this.camera.projectionMatrix.copy(clipFromModel(P, photo.width, photo.height, this.model.radius));
    this.camera.projectionMatrixInverse.copy(this.camera.projectionMatrix).invert();
    const {eye, up} = eyeOf(P, this.model.radius);
    this.sun.position.copy(eye).addScaledVector(up, this.model.radius);
    this.renderer.render(this.scene, this.camera);
    return this.canvas;
  }
}
