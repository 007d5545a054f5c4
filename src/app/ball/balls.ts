import {
  Group,
  InstancedMesh,
  Matrix4,
  type Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  type Object3D,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import type { BallState } from '../../core/games/ball/ball-state';
import type { Opening } from '../../core/games/ball/basket';
import { ballRadius, basketDepth, basketRadius } from '../../core/games/ball/flight';
import { ballPosition } from '../../core/games/ball/state-readings';
import { addScaled, dot, length, reject, subtract, type Vec3 } from '../../core/math/vec3';
import { disposeTree } from '../../scene/dispose-tree';
import { painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { createShadowDiscs } from './shadow-discs';

/** All balls of a match, wherever they are; arena frame. */
export interface Balls {
  readonly object: Object3D;
  /** At a time of the match [s]; inHand: where the fist is that holds a ball; null: it is not seen. */
  show(
    state: BallState,
    time: number,
    inHand: (player: number, side: 'left' | 'right') => Vec3 | null,
    opening: Opening | null,
  ): void;
  dispose(): void;
}

/** Told apart by lightness and by the number of their bands: those of the first rack and of the second. */
const looks = [
  { skin: '#ffd24a', band: '#173a6b', bands: [0] },
  { skin: '#f4f6f8', band: '#7c2413', bands: [-0.36, 0.36] },
] as const;

function geometryOf(look: (typeof looks)[number], quality: Quality) {
  const [around, down] = quality === 'high' ? [40, 28] : [20, 16];
  return painted(new SphereGeometry(ballRadius, around, down), (_x, y, _z, paint) => {
    const onBand = look.bands.some((at) => Math.abs(y / ballRadius - at) < 0.17);
    paint.set(onBand ? look.band : look.skin);
  });
}

/** In the basket balls lie in layers of five about the first one [m, in the basket's frame: outward on two axes, up]. */
function placeInBasket(index: number): readonly [number, number, number] {
  const layer = Math.floor(index / 5);
  const slot = index % 5;
  const angle = (slot / 5) * 2 * Math.PI + layer * 0.6;
  const out = 0.122;
  return [Math.cos(angle) * out, -basketDepth + ballRadius + 0.01 + layer * 0.085, Math.sin(angle) * out];
}

/** What has gone down through the opening goes no further than the basket's bottom. */
function stoppedBy(opening: Opening | null, position: Vec3): Vec3 {
  if (!opening) return position;
  const from = subtract(position, opening.position);
  const height = dot(from, opening.normal);
  const deepest = ballRadius - basketDepth;
  if (height > deepest || height < -1.2 || length(reject(from, opening.normal)) > basketRadius) return position;
  return addScaled(position, opening.normal, deepest - height);
}

export function createBalls(count: number, quality: Quality): Balls {
  const object = new Group();
  object.name = 'balls';
  const perLook = Math.ceil(count / 2);
  const material =
    quality === 'high'
      ? new MeshStandardMaterial({ vertexColors: true, roughness: 0.55 })
      : new MeshLambertMaterial({ vertexColors: true });
  const meshes = looks.map((look) => {
    const mesh = new InstancedMesh(geometryOf(look, quality), material, perLook);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    return mesh;
  });
  const shadows = createShadowDiscs(count);
  object.add(...meshes, shadows.object);
  const matrix = new Matrix4();
  const at = new Vector3();
  const turn = new Quaternion();
  const axis = new Vector3();
  const one = new Vector3(1, 1, 1);
  const gone = new Matrix4().makeScale(0, 0, 0);
  const basketTurn = new Quaternion();
  const upward = new Vector3(0, 1, 0);

  /** A ball that flies tumbles forward; one that rolls turns as far as it has gone. */
  function turned(state: BallState, ball: number, time: number, position: Vec3): void {
    const place = state.balls[ball];
    turn.setFromAxisAngle(axis.set(0.6, 0.2, 0.77).normalize(), ball * 1.9);
    if (place?.on !== 'air' && place?.on !== 'floor') return;
    const { velocity, position: from } = place.launch;
    axis.set(velocity.z, 0, -velocity.x);
    if (axis.lengthSq() < 1e-6) return;
    axis.normalize();
    const angle =
      place.on === 'air'
        ? Math.min(9, 1.6 * length(velocity)) * Math.max(0, time - place.launch.time)
        : Math.hypot(position.x - from.x, position.z - from.z) / ballRadius;
    turn.premultiply(new Quaternion().setFromAxisAngle(axis, angle));
  }

  return {
    object,
    show(state, time, inHand, opening) {
      let caught = 0;
      state.balls.forEach((place, ball) => {
        const mesh = meshes[ball < perLook ? 0 : 1] as Mesh as InstancedMesh;
        const index = ball % perLook;
        let position = ballPosition(state, ball, time);
        if (place.on === 'hand') position = inHand(place.player, place.side);
        if (place.on === 'basket') {
          const [x, y, z] = placeInBasket(caught);
          caught += 1;
          const held = opening ?? state.basket;
          basketTurn.setFromUnitVectors(upward, at.copy(held.normal));
          at.set(x, y, z).applyQuaternion(basketTurn).add(held.position);
          position = { x: at.x, y: at.y, z: at.z };
        }
        // A catch is told a moment later: until then the ball lies where it fell.
        if (place.on === 'air' && !place.missed && position) position = stoppedBy(opening, position);
        // A full basket shows three layers of balls: those below them are hidden.
        if (!position || (place.on === 'basket' && caught > 15)) {
          mesh.setMatrixAt(index, gone);
          shadows.hide(ball);
          return;
        }
        turned(state, ball, time, position);
        mesh.setMatrixAt(index, matrix.compose(at.copy(position), turn, one));
        if (place.on === 'air' || place.on === 'floor') shadows.put(ball, position);
        else shadows.hide(ball);
      });
      for (const mesh of meshes) mesh.instanceMatrix.needsUpdate = true;
      shadows.update();
    },
    dispose() {
      object.removeFromParent();
      for (const mesh of meshes) mesh.dispose();
      disposeTree(object);
    },
  };
}
