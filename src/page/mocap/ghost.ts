import {
  Color,
  CylinderGeometry,
  Group,
  InstancedMesh,
  type Material,
  Matrix4,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import type { TruthJoint } from 'threepoint/internal';
import type { Quat, Vec3 } from 'threepoint/math';

type Places = Readonly<Partial<Record<TruthJoint, Vec3>>>;

/** The bones that are drawn, from joint to joint. */
const bones: readonly (readonly [TruthJoint, TruthJoint])[] = [
  ['hips', 'spine'],
  ['spine', 'chest'],
  ['chest', 'neck'],
  ['neck', 'head'],
  ...(['left', 'right'] as const).flatMap((side) => [
    ['neck', `${side}UpperArm`] as const,
    [`${side}UpperArm`, `${side}LowerArm`] as const,
    [`${side}LowerArm`, `${side}Hand`] as const,
    ['hips', `${side}UpperLeg`] as const,
    [`${side}UpperLeg`, `${side}LowerLeg`] as const,
    [`${side}LowerLeg`, `${side}Foot`] as const,
    [`${side}Foot`, `${side}Toes`] as const,
  ]),
];
const joints: readonly TruthJoint[] = [...new Set(bones.flat())];
const boneRadius = 0.014;
const jointRadius = 0.024;
/** The radius of the head, and its centre relative to the head joint, head frame [m]. */
const skull = { radius: 0.075, middle: new Vector3(0, 0.07, -0.015) };

const colour = new Color('#7ff0d2');
const up = new Vector3(0, 1, 0);
const nowhere = new Matrix4().makeScale(0, 0, 0);

/** Draws the true joints of a person as a stick figure that is visible through the body around it. */
export class Ghost {
  readonly object = new Group();
  readonly #sticks: readonly InstancedMesh[];
  readonly #balls: readonly InstancedMesh[];
  readonly #matrix = new Matrix4();
  readonly #from = new Vector3();
  readonly #to = new Vector3();
  readonly #along = new Vector3();
  readonly #size = new Vector3();
  readonly #turn = new Quaternion();

  constructor() {
    this.object.name = 'truth';
    const stick = new CylinderGeometry(1, 1, 1, 10, 1, true);
    const ball = new SphereGeometry(1, 16, 12);
    // The figure is drawn twice: solid, and faintly over everything in front of it.
    const solid = new MeshLambertMaterial({ color: colour, emissive: colour, emissiveIntensity: 0.25 });
    const faint = new MeshBasicMaterial({
      color: colour,
      transparent: true,
      opacity: 0.42,
      depthTest: false,
      depthWrite: false,
    });
    const pair = (make: (material: Material) => InstancedMesh): readonly InstancedMesh[] => {
      const [first, second] = [make(solid), make(faint)] as const;
      second.instanceMatrix = first.instanceMatrix;
      second.renderOrder = 9;
      return [first, second];
    };
    this.#sticks = pair((material) => new InstancedMesh(stick, material, bones.length));
    this.#balls = pair((material) => new InstancedMesh(ball, material, joints.length + 1));
    for (const mesh of [...this.#sticks, ...this.#balls]) {
      mesh.frustumCulled = false;
      this.object.add(mesh);
    }
  }

  /** Draws the joints that are known. `headTurn`: the rotation of the head, floor frame. */
  show(places: Places, headTurn: Quat): void {
    for (const [i, [from, to]] of bones.entries()) this.#placeStick(i, places[from], places[to]);
    for (const [i, joint] of joints.entries()) {
      const at = places[joint];
      this.#placeBall(i, at ? this.#from.set(at.x, at.y, at.z) : null, jointRadius);
    }
    const { head } = places;
    if (head) {
      const { x, y, z, w } = headTurn;
      const middle = this.#from.copy(skull.middle).applyQuaternion(this.#turn.set(x, y, z, w));
      this.#placeBall(joints.length, middle.add(head), skull.radius);
    }
    this.#sticks[0]!.instanceMatrix.needsUpdate = true;
    this.#balls[0]!.instanceMatrix.needsUpdate = true;
  }

  #placeStick(index: number, start: Vec3 | undefined, end: Vec3 | undefined): void {
    const [mesh] = this.#sticks as [InstancedMesh];
    if (!start || !end) {
      mesh.setMatrixAt(index, nowhere);
      return;
    }
    const from = this.#from.set(start.x, start.y, start.z);
    const to = this.#to.set(end.x, end.y, end.z);
    const length = from.distanceTo(to);
    const turn = this.#turn.setFromUnitVectors(up, this.#along.subVectors(to, from).normalize());
    const middle = from.add(to).multiplyScalar(0.5);
    mesh.setMatrixAt(index, this.#matrix.compose(middle, turn, this.#size.set(boneRadius, length, boneRadius)));
  }

  #placeBall(index: number, at: Vector3 | null, radius: number): void {
    const [mesh] = this.#balls as [InstancedMesh];
    const matrix = at ? this.#matrix.makeScale(radius, radius, radius).setPosition(at) : nowhere;
    mesh.setMatrixAt(index, matrix);
  }
}
