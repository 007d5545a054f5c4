import { BoxGeometry, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, PlaneGeometry, type Texture } from 'three';
import { woodColor } from '../outdoors/wood';
import { merged, painted } from '../painted-geometry';

export interface WoodenBoardShape {
  /** The width of the lettering [m]. */
  readonly width: number;
  readonly height: number;
  /** Height of its middle above the ground [m]. */
  readonly middle: number;
}

/** Width, height, depth, or where the middle is [m]. */
type Triple = readonly [number, number, number];

/** A board with a frame and a little roof on two posts, its writing towards +Z; its origin is on the ground. */
export function createWoodenBoard({ width, height, middle }: WoodenBoardShape, texture: Texture): Group {
  const object = new Group();
  const frame = 0.09;
  const box = ([w, h, d]: Triple, [x, y, z]: Triple, seed: number) =>
    painted(new BoxGeometry(w, h, d).translate(x, y, z), woodColor(seed));
  const wood = new Mesh(
    merged([
      box([width + 2 * frame, frame, 0.09], [0, middle + (height + frame) / 2, 0], 0),
      box([width + 2 * frame, frame, 0.09], [0, middle - (height + frame) / 2, 0], 1),
      box([frame, height, 0.09], [-(width + frame) / 2, middle, 0], 2),
      box([frame, height, 0.09], [(width + frame) / 2, middle, 0], 3),
      box([width, height, 0.03], [0, middle, -0.02], 1),
      box([0.13, middle + height / 2, 0.1], [-width * 0.36, (middle + height / 2) / 2 - 0.02, -0.075], 2),
      box([0.13, middle + height / 2, 0.1], [width * 0.36, (middle + height / 2) / 2 - 0.02, -0.075], 0),
      // A little roof.
      painted(
        new BoxGeometry(width + 0.34, 0.03, 0.3).rotateX(0.22).translate(0, middle + height / 2 + 0.13, 0.02),
        '#4f5b63',
      ),
    ]),
    new MeshLambertMaterial({ vertexColors: true }),
  );
  wood.castShadow = wood.receiveShadow = true;
  const face = new Mesh(new PlaneGeometry(width, height), new MeshBasicMaterial({ map: texture, fog: false }));
  face.position.set(0, middle, 0.004);
  object.add(wood, face);
  return object;
}
