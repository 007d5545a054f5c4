import { BoxGeometry, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, PlaneGeometry, type Texture } from 'three';
import { woodColor } from '../outdoors/wood-color';
import { merged, painted, paintedBox } from '../painted-geometry';

interface WoodenBoardShape {
  /** The width of the lettering [m]. */
  readonly width: number;
  readonly height: number;
  /** Height of its middle above the ground [m]. */
  readonly middle: number;
}

/** A board with a frame and a little roof on two posts, its writing towards +Z; its origin is on the ground. */
export function createWoodenBoard({ width, height, middle }: WoodenBoardShape, texture: Texture): Group {
  const object = new Group();
  const frame = 0.09;
  const wood = new Mesh(
    merged([
      paintedBox([width + 2 * frame, frame, 0.09], [0, middle + (height + frame) / 2, 0], woodColor(0)),
      paintedBox([width + 2 * frame, frame, 0.09], [0, middle - (height + frame) / 2, 0], woodColor(1)),
      paintedBox([frame, height, 0.09], [-(width + frame) / 2, middle, 0], woodColor(2)),
      paintedBox([frame, height, 0.09], [(width + frame) / 2, middle, 0], woodColor(3)),
      paintedBox([width, height, 0.03], [0, middle, -0.02], woodColor(1)),
      paintedBox(
        [0.13, middle + height / 2, 0.1],
        [-width * 0.36, (middle + height / 2) / 2 - 0.02, -0.075],
        woodColor(2),
      ),
      paintedBox(
        [0.13, middle + height / 2, 0.1],
        [width * 0.36, (middle + height / 2) / 2 - 0.02, -0.075],
        woodColor(0),
      ),
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
