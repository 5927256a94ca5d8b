// The embedded model: a glTF file, its surfaces, and how each is shown.
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {picture} from './dom.js';

const seenColors = [0x2f9aa6, 0x7b61c9, 0x3d8f4f, 0xb3588e, 0x5b7fd1, 0x94852b];
export const grownColor = 0xe69f00;
export const unseenColor = 0x9aa3ad;

function bytesOf(id) {
  const text = document.getElementById(id).textContent.trim();
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text).buffer;
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes.buffer;
}

export function load(id) {
  return new Promise((resolve, reject) => new GLTFLoader().parse(bytesOf(id), '', resolve, reject));
}

/** "seen" where a photo painted it, "grown" beside that, "unseen", or "surface" where there are no photos. */
function kindOf(name) {
  return ['grown', 'unseen', 'surface'].includes(name) ? name : 'seen';
}

function coverageTexture(name) {
  const image = picture(`coverage:${name}`);
  if (!image) return null;
  const texture = new THREE.Texture(image);
  texture.flipY = false;
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.needsUpdate = true;
  return texture;
}

/** The surfaces of a loaded model, with a material for every way of showing them. */
export class Model {
  constructor(gltf) {
    this.scene = gltf.scene;
    this.surfaces = [];
    let seen = 0;
    this.scene.traverse((node) => {
      if (!node.isMesh) return;
      const given = node.material;
      const kind = kindOf(given.name);
      const common = {map: given.map, color: given.color, vertexColors: given.vertexColors, side: THREE.DoubleSide};
      const flat = kind === 'grown' ? grownColor : kind === 'seen' ? seenColors[seen++ % seenColors.length] : unseenColor;
      const coverage = kind === 'seen' ? coverageTexture(given.name) : null;
      const materials = {
        photo: new THREE.MeshBasicMaterial(common),
        lit: new THREE.MeshStandardMaterial({...common, roughness: 0.85, metalness: 0}),
        shape: new THREE.MeshStandardMaterial({color: 0xc9cdd2, roughness: 0.9, metalness: 0, side: THREE.DoubleSide}),
        coverage: new THREE.MeshStandardMaterial({color: flat, roughness: 1, metalness: 0, side: THREE.DoubleSide}),
        texels: coverage && new THREE.MeshBasicMaterial({map: coverage, side: THREE.DoubleSide}),
      };
      materials.texels ??= materials.coverage;
      for (const material of Object.values(materials)) {
        // The wires lie on the surface, not in it.
        material.polygonOffset = true;
        material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
      }
      if (given.map) given.map.anisotropy = 8;
      const wires = new THREE.Mesh(node.geometry, new THREE.MeshBasicMaterial({
        color: 0x101820, wireframe: true, transparent: true, opacity: 0.35,
      }));
      wires.visible = false;
      wires.raycast = () => {};
      this.surfaces.push({node, kind, name: given.name, color: flat, materials, wires});
      node.material = materials.photo;
    });
    for (const {node, wires} of this.surfaces) node.add(wires);
    this.box = new THREE.Box3().setFromObject(this.scene);
    this.center = this.box.getCenter(new THREE.Vector3());
    this.radius = Math.max(0.5 * this.box.getSize(new THREE.Vector3()).length(), 1e-9);
  }

  get triangles() {
    return this.surfaces.reduce((sum, {node}) => sum + node.geometry.index.count / 3, 0);
  }

  show(mode, wireframe) {
    for (const {node, materials, wires} of this.surfaces) {
      node.material = materials[mode];
      wires.visible = wireframe;
    }
  }
}
