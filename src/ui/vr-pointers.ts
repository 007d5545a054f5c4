import {
  BufferGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
  SphereGeometry,
  Vector3,
} from 'three';
import type { Pointer } from 'threepoint/core';

/** Two hands, a pinch of each and a gaze. */
const maxPointers = 5;
/** A gaze that meets nothing shows its dot this far away [m]: the user must see where the head points. */
const gazeDistance = 2;
const dotRadius = 0.007;
/** The ring of a gaze, as a share of its distance: 4° wide. */
const ringShare = 0.035;
const ringSegments = 48;

const seen = { fog: false, toneMapped: false } as const;
const ahead = new Vector3(0, 0, -1);

/** A ring that fills clockwise from the top, over everything. */
function createRing(color: string, opacity: number): Mesh {
  const look = {
    color,
    opacity,
    depthTest: false,
    transparent: true,
    side: DoubleSide,
    forceSinglePass: true,
    ...seen,
  } as const;
  return new Mesh(new RingGeometry(0.74, 1, ringSegments, 1, Math.PI / 2, -2 * Math.PI), new MeshBasicMaterial(look));
}

class DrawnPointer {
  readonly object = new Group();
  readonly #line = new Line(
    new BufferGeometry().setAttribute('position', new Float32BufferAttribute([0, 0, 0, 0, 0, -1], 3)),
    new LineBasicMaterial({ color: '#ffb468', transparent: true, opacity: 0.7, ...seen }),
  );
  readonly #dot = new Mesh(new SphereGeometry(dotRadius, 12, 8), new MeshBasicMaterial({ color: '#ffe3c4', ...seen }));
  readonly #ring = createRing('#ffb468', 1);
  /** The part of the ring that is not filled yet. */
  readonly #track = createRing('#0b1018', 0.6);
  readonly #direction = new Vector3();

  constructor() {
    this.#ring.name = 'dwell ring';
    this.#ring.renderOrder = 11;
    this.#track.renderOrder = 10;
    this.#ring.add(this.#track);
    this.object.add(this.#line, this.#dot, this.#ring);
  }

  show(pointer: Pointer): void {
    const { origin, direction, pointedAt, source, progress } = pointer;
    const gazes = source === 'gaze';
    const distance = pointedAt?.distance ?? (gazes ? gazeDistance : null);
    this.object.visible = distance !== null;
    if (distance === null) return;
    this.object.position.copy(origin);
    this.object.quaternion.setFromUnitVectors(ahead, this.#direction.copy(direction));
    // A line that begins between the eyes would only blind its user.
    this.#line.visible = !gazes && source !== 'transient';
    this.#line.scale.z = distance;
    this.#dot.position.z = -distance;
    this.#dot.scale.setScalar(gazes ? Math.max(1, distance / gazeDistance) : 1);
    this.#ring.visible = progress > 0;
    if (!this.#ring.visible) return;
    this.#ring.position.z = -distance;
    this.#ring.scale.setScalar(ringShare * distance);
    this.#ring.geometry.setDrawRange(0, 6 * Math.ceil(ringSegments * progress));
  }
}

/** Shows where pointers point; in the space that they are given in. */
export function createVrPointers() {
  const objects = new Group();
  const drawn = Array.from({ length: maxPointers }, () => new DrawnPointer());
  for (const { object } of drawn) objects.add(object);
  return {
    objects,
    /** Draws the pointers of a frame, after everything has reported what they point at. */
    show(pointers: readonly Pointer[]): void {
      for (let i = 0; i < drawn.length; i++) {
        const each = drawn[i]!;
        const pointer = pointers[i];
        if (pointer) each.show(pointer);
        else each.object.visible = false;
      }
    },
  };
}

export type VrPointers = ReturnType<typeof createVrPointers>;
