import { CylinderGeometry, Group, Mesh, MeshLambertMaterial, TorusGeometry } from 'three';
import type { BowView } from '../../core/games/archery/archery-state';
import { arrowRestHeight, braceHeight } from '../../core/games/archery/bow';
import type { Quat } from '../../core/math/quat';
import { rotate } from '../../core/math/quat';
import { add, type Vec3, vec3 } from '../../core/math/vec3';
import { disposeTree } from '../../scene/dispose-tree';
import { woodColor } from '../../scene/outdoors/wood';
import { merged, painted } from '../../scene/painted-geometry';

/** What holds the bow while no hand does; floor frame. */
export interface BowStand {
  readonly object: Group;
  /** Where the grip hangs [m]; null: the stand is put away. */
  show(grip: Vec3 | null): void;
  dispose(): void;
}

/** A bow that hangs upright with its grip at `grip`, facing where `facing` turns −Z; floor frame. */
export const hangingBow = (grip: Vec3, facing: Quat): BowView => ({
  bowSide: 'left',
  bow: { position: grip, orientation: facing },
  nockPoint: add(grip, rotate(facing, vec3(0, arrowRestHeight, braceHeight))),
  draw: 0,
  stage: 'empty',
  arrow: null,
});

/** How far ahead of the grip its post stands [m]. */
const ahead = 0.055;

export function createBowStand(facing: Quat): BowStand {
  const object = new Group();
  object.name = 'bow stand';
  object.quaternion.copy(facing);
  const material = new MeshLambertMaterial({ vertexColors: true });
  const post = new Mesh(
    painted(new CylinderGeometry(0.016, 0.02, 1, 8).translate(0, 0.5, -ahead), woodColor(1)),
    material,
  );
  const foot = new Mesh(
    painted(new CylinderGeometry(0.15, 0.17, 0.03, 20).translate(0, 0.015, -ahead), woodColor(2)),
    material,
  );
  const fork = new Mesh(
    merged([painted(new TorusGeometry(0.034, 0.007, 6, 16, Math.PI).rotateX(Math.PI / 2).rotateY(Math.PI), '#39434b')]),
    material,
  );
  for (const mesh of [post, foot, fork]) mesh.castShadow = true;
  object.add(post, foot, fork);
  object.visible = false;
  return {
    object,
    show(grip) {
      object.visible = grip !== null;
      if (!grip) return;
      object.position.set(grip.x, 0, grip.z);
      post.scale.y = grip.y - 0.09;
      fork.position.y = grip.y - 0.085;
    },
    dispose() {
      object.removeFromParent();
      disposeTree(object);
    },
  };
}
