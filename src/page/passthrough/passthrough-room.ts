import { Fog, type Object3D } from 'three';
import type { BoundarySize } from 'threepoint/internal';
import { thirdPersonOnlyLayer } from 'threepoint/internal/three';
import type { Notices } from 'threepoint-ui';
import type { Activity, FloorNeeds } from '../activity/activity';
import type { Surroundings } from '../scene/surroundings';
import { wallDistance } from '../studio/mirrors';
import type { Studio } from '../studio/studio';
import { detectedFloors, hasSpace } from './floor-space';
import { MirrorStand, type StoredAnchor } from './mirror-stand';
import { RoomLight } from './room-light';

export interface PassthroughOptions {
  readonly session: XRSession;
  /** The space within the boundary of the headset; null: the device does not report it. */
  readonly room: BoundarySize | null;
  readonly studio: Studio;
  readonly notices: Pick<Notices, 'show'>;
  readonly kept: StoredAnchor;
  floorSpace(): XRReferenceSpace | null;
  /** The current activity; null: the user is at the mirror. */
  activity(): Pick<Activity, 'place' | 'floor'> | null;
  standMirror(x: number, floor: number, z: number, turned: number): void;
  /** Whether a menu lies before the mirror, under the hands' rays. */
  isCovered(): boolean;
}

/** The start of the fog in passthrough, beyond any room [m]. */
const fogStart = 1e5;
/** Returns the notice that the room is smaller than an activity needs. */
function tooSmall({ place }: Pick<Activity, 'place'>, { halfWidth, ahead, behind }: FloorNeeds): string {
  const size = `${2 * halfWidth} × ${ahead + behind} m`;
  return `${place} needs ${size} of free floor in front of you. Your room is smaller, so the usual world is shown.`;
}

/**
 * The user's own room in place of the studio, for one session: the mirror stands in it, its light falls on the avatar,
 * and an activity is placed in it at true distances where the floor is large enough.
 */
export class PassthroughRoom {
  readonly mirror: MirrorStand;
  readonly #options: PassthroughOptions;
  readonly #light = new RoomLight();
  readonly #hidden = new Set<Object3D>();
  #arranged: Surroundings | null = null;
  #showsRoom = true;

  constructor(options: PassthroughOptions) {
    const { session, studio, kept, floorSpace, isCovered } = options;
    this.#options = options;
    this.mirror = new MirrorStand({ session, kept, floorSpace, isCovered });
    void this.#light.start(session);
    // The mirror shows the studio behind the avatar: it cannot show the room.
    studio.setLayer(thirdPersonOnlyLayer);
    studio.setRealFloor(0);
  }

  /** Whether the user sees the own room, not the world of an activity. */
  get showsRoom(): boolean {
    return this.#showsRoom;
  }

  /** Updates the room for the picture of this frame. `time`: [s]. */
  update(frame: XRFrame, time: number): void {
    const { floorSpace, studio, standMirror, activity } = this.#options;
    const floor = floorSpace();
    if (!floor) return;
    if (studio.surroundings !== this.#arranged) this.#arrange(frame, floor);
    this.mirror.update(frame, time);
    if (activity() === null) {
      const { x, y, z, turned } = this.mirror.place;
      standMirror(x, y, z, turned);
      // The mirror shows the studio as if it hung on the wall there.
      studio.home.position.set(x + wallDistance * Math.sin(turned), y, z + wallDistance * Math.cos(turned));
      studio.home.rotation.y = turned;
      studio.setRealFloor(y);
    }
    const light = this.#showsRoom ? this.#light.read(frame, floor) : null;
    if (light) studio.setEstimatedLight(light);
  }

  dispose(): void {
    const { studio } = this.#options;
    this.mirror.dispose();
    studio.home.position.set(0, 0, 0);
    studio.home.rotation.y = 0;
    studio.setLayer(0);
    studio.setRealFloor(null);
    for (const node of this.#hidden) node.visible = true;
    studio.restore();
  }

  /** Shows the room around the studio's mirror, or an activity in it if the floor is large enough. */
  #arrange(frame: XRFrame, floor: XRReferenceSpace): void {
    const { studio, activity, notices } = this.#options;
    this.#arranged = studio.surroundings;
    for (const node of this.#hidden) node.visible = true;
    this.#hidden.clear();
    const current = activity();
    const needs = current?.floor;
    this.#showsRoom = current === null || (needs !== undefined && this.#hasFloor(needs, frame, floor));
    if (current && needs && !this.#showsRoom) notices.show('info', tooSmall(current, needs));
    if (!this.#showsRoom) return;
    if (current) this.#hide(studio.surroundings.scenery);
    const { fog } = studio.scene;
    if (fog instanceof Fog) Object.assign(fog, { near: fogStart, far: 2 * fogStart });
  }

  #hide(scenery: readonly Object3D[]): void {
    for (const node of scenery) {
      if (!node.visible) continue;
      node.visible = false;
      this.#hidden.add(node);
    }
  }

  #hasFloor(needs: FloorNeeds, frame: XRFrame, floor: XRReferenceSpace): boolean {
    const floors = detectedFloors(frame, floor);
    if (floors.length > 0) return floors.some((polygon) => hasSpace(polygon, needs));
    const { room } = this.#options;
    return room !== null && room.width >= 2 * needs.halfWidth && room.depth >= needs.ahead + needs.behind;
  }
}
