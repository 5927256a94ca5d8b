// Cameras as 3x4 projection matrices, in the frame of the page's model (glTF: metres, y up, about the model's middle).
import {Matrix4, Vector3} from 'three';

/** Twelve numbers, row by row, times a 4x4 matrix from the new frame to the old one. */
export function inFrame(P, oldFromNew) {
  const m = oldFromNew.elements;  // column by column
  const out = [];
  for (let row = 0; row < 3; ++row)
    for (let column = 0; column < 4; ++column) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += P[4 * row + k] * m[4 * column + k];
      out.push(sum);
    }
  return out;
}

export function rowMajor(numbers) {
  return new Matrix4().set(...numbers);
}

const row = (P, r) => new Vector3(P[4 * r], P[4 * r + 1], P[4 * r + 2]);

/** A last row of 0 0 0 w: an orthographic camera. */
export function isOrthographic(P) {
  return row(P, 2).length() <= 1e-9 * Math.abs(P[11]);
}

/**
 * P scaled so that w is the depth (perspective; positive in front) or 1 (orthographic), and the row that gives the depth along the
 * optical axis.
 */
export function normalized(P) {
  if (isOrthographic(P)) {
    const scaled = P.map((value) => value / P[11]);
    const axis = row(scaled, 0).cross(row(scaled, 1)).normalize();
    return {P: scaled, depth: [axis.x, axis.y, axis.z, 0]};
  }
  // The sign for which the left part has a positive determinant: the camera's axes are right-handed.
  const determinant = row(P, 0).dot(row(P, 1).cross(row(P, 2)));
  const scale = (determinant < 0 ? -1 : 1) / row(P, 2).length();
  const scaled = P.map((value) => value * scale);
  return {P: scaled, depth: scaled.slice(8)};
}

/** The matrix that WebGL takes from the model's frame to its clip space, for pixels of a picture of this size. */
export function clipFromModel(P, width, height, radius) {
  const {P: p, depth} = normalized(P);
  const orthographic = isOrthographic(P);
  const middle = depth[3];  // depth of the frame's origin, which is the model's middle
  const near = orthographic ? middle - 4 * radius : Math.max(middle - 4 * radius, 0.02 * Math.abs(middle) + 1e-9);
  const far = Math.max(middle + 4 * radius, near + radius);
  const m = new Matrix4();
  const rows = [[], [], [], []];
  for (let c = 0; c < 4; ++c) {
    const w = p[8 + c];
    rows[0].push(2 * p[c] / width - w);
    rows[1].push(w - 2 * p[4 + c] / height);
    rows[3].push(w);
    rows[2].push(orthographic ? 2 * depth[c] / (far - near) : (far + near) / (far - near) * depth[c]);
  }
  rows[2][3] -= orthographic ? (far + near) / (far - near) : 2 * far * near / (far - near);
  m.set(...rows.flat());
  return m;
}

/** Where the camera is, and where it looks; of an orthographic one a place far off along its axis. */
export function eyeOf(P, radius) {
  const {P: p} = normalized(P);
  if (isOrthographic(P)) {
    const axis = row(p, 0).cross(row(p, 1)).normalize();
    return {eye: axis.clone().multiplyScalar(-6 * radius), forward: axis, up: row(p, 1).normalize().negate()};
  }
  const left = new Matrix4().set(p[0], p[1], p[2], 0, p[4], p[5], p[6], 0, p[8], p[9], p[10], 0, 0, 0, 0, 1);
  const eye = new Vector3(p[3], p[7], p[11]).negate().applyMatrix4(left.invert());
  const forward = row(p, 2).normalize();
  const up = row(p, 1).negate();
  up.addScaledVector(forward, -up.dot(forward)).normalize();
  return {eye, forward, up};
}

export function project(P, x) {
  const w = P[8] * x.x + P[9] * x.y + P[10] * x.z + P[11];
  return [
    (P[0] * x.x + P[1] * x.y + P[2] * x.z + P[3]) / w,
    (P[4] * x.x + P[5] * x.y + P[6] * x.z + P[7]) / w,
  ];
}
