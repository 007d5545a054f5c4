import type { Avatar } from 'threepoint/avatar/avatar';
import { createDebugSkeleton } from 'threepoint/avatar/debug-skeleton';
import { Mirror } from 'threepoint/avatar/mirror';
import { createHeadLoss } from 'threepoint/avatar/rig/head-loss';
import type { Side } from 'threepoint/core/math/side';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { type Savings, unjudgedSavings } from 'threepoint/xr/frame-rate';
import { createVrCaptions } from 'threepoint-ui/vr-captions';
import type { Watched } from '../activity/activity';
import { DesktopView, type Insets } from '../scene/desktop-view';
import { createHeadsetCamera, createRenderer, fitToWindow, type Quality } from '../scene/renderer';
import { createVignette, type Vignette } from '../scene/vignette';
import { createStudio, type Studio } from '../studio/studio';

/** The user stands at the origin and looks along −Z, at the mirror [m]. */
const mirrorDistance = 1.5;
/** A mirror at the user's right is out of the way of what flies ahead [m, rad]. */
const mirrorAside = { x: 1.95, z: -0.1, turned: -1.3 };
/** The position of the shadow and the light of an absent body [m]. */
const outOfSight = 100;
/** Longest step of a camera that follows [s]: a page that was asleep does not leap. */
const longestStep = 0.1;
/** The height of the pelvis as a share of the eye height, without a body. */
const pelvisShare = 0.58;

/** What a picture, or a part of it, asks of the graphics device. */
export interface DrawnCounts {
  readonly drawCalls: number;
  readonly triangles: number;
}

/** One picture: its people and its viewer. */
export interface Shot {
  readonly time: number;
  /** null: the head is not seen. */
  readonly frame: TrackingFrame | null;
  /** null: not loaded yet. */
  readonly avatar: Avatar | null;
  readonly inSession: boolean;
  /** How far to the right of its user the body of a session is drawn [m]; 0: where the user is. */
  readonly beside: number;
  /** The distance of the middle of what is looked at to the right of the body [m]. */
  readonly aside: number;
  /** The person that a camera without a body of its own looks at; null: there is a body. */
  readonly watched: Watched | null;
  /**
   * never; always; or only for a camera that does not stand behind the mirror: from there one wants to see the body.
   */
  readonly mirror: 'never' | 'always' | 'unless-behind';
  /** What the picture of a session gives up so that its frames are in time. */
  readonly savings: Savings;
}

/** What is always there to be drawn, and the cameras it is drawn with. */
export interface Stage {
  readonly renderer: ReturnType<typeof createRenderer>;
  readonly studio: Studio;
  readonly view: DesktopView;
  readonly vignette: Vignette;
  /** The newest picture: its reflections in the mirror, and the rest with all eyes and shadows. */
  readonly drawn: Readonly<Record<'mirror' | 'scene', DrawnCounts>>;
  /** What the newest picture gave up. */
  readonly savings: Savings;
  /** A line low before the eyes of a session; empty: none. */
  caption(text: string): void;
  /** Places the mirror at this side of the user; null: ahead of the user. */
  placeMirror(side: Side | null): void;
  /** Stands the mirror on the floor at this height, its middle at (x, z) [m]; turned by 0 it faces +Z [rad]. */
  standMirror(x: number, floor: number, z: number, turned: number): void;
  setSkeletonVisible(visible: boolean): void;
  /** Fits picture and camera to the window; insets: what the controls cover [CSS pixels]. */
  layOut(insets: Insets): void;
  /** Light and camera go where the body is: before anything is drawn that depends on the camera. */
  look(shot: Shot): void;
  draw(shot: Shot): void;
}

export function createStage(canvas: HTMLCanvasElement, quality: Quality): Stage {
  const renderer = createRenderer(canvas, quality);
  const studio = createStudio(renderer, quality);
  const view = new DesktopView(canvas);
  const mirror = new Mirror({
    distance: mirrorDistance,
    ...(quality === 'low' && { resolution: 400, samples: 0 }),
  });
  const skeleton = createDebugSkeleton();
  const headLoss = createHeadLoss();
  const vignette = createVignette();
  const headsetCamera = createHeadsetCamera();
  const captions = createVrCaptions();
  studio.scene.add(mirror.object, skeleton.object, vignette.object, captions.object);
  const mirrorHeight = mirror.object.position.y;
  let lastTime = 0;
  const { info } = renderer;
  let spared = unjudgedSavings;
  const save = (savings: Savings): void => {
    if (savings === spared) return;
    spared = savings;
    renderer.xr.setFoveation(savings.foveation);
    mirror.setMostRate(savings.mirrorRateHz);
  };
  // A picture has several renders, and three.js would restart its counts in each of them.
  info.autoReset = false;
  const drawn = { mirror: { drawCalls: 0, triangles: 0 }, scene: { drawCalls: 0, triangles: 0 } };
  const count = (part: 'mirror' | 'scene'): void => {
    drawn[part].drawCalls = info.render.calls;
    drawn[part].triangles = info.render.triangles;
    info.reset();
  };

  return {
    renderer,
    studio,
    view,
    vignette,
    drawn,
    get savings() {
      return spared;
    },
    caption: captions.setText,
    placeMirror(side) {
      const { x, z, turned } = mirrorAside;
      const sign = side === 'right' ? 1 : -1;
      if (side) mirror.place(sign * x, z, sign * turned);
      else mirror.place(0, -mirrorDistance, 0);
      mirror.object.position.y = mirrorHeight;
    },
    standMirror(x, floor, z, turned) {
      mirror.place(x, z, turned);
      mirror.object.position.y = mirrorHeight + floor;
    },
    setSkeletonVisible: (visible) => skeleton.setVisible(visible),
    layOut(insets) {
      view.setInsets(insets);
      view.resize();
      fitToWindow(renderer, quality);
    },
    look({ time, frame, avatar, inSession, aside, watched, beside }) {
      const elapsed = Math.min(longestStep, Math.max(0, time - lastTime));
      lastTime = time;
      const hips = avatar?.jointPositions().hips;
      view.setHeight(avatar?.height ?? 0);
      if (watched) studio.follow(watched.pelvis.x, outOfSight);
      else if (hips) studio.follow(hips.x + beside, hips.z);
      if (inSession) return;
      if (watched) view.update(watched.pelvis, watched.eyes, elapsed);
      else if (frame) {
        const { position } = frame.head;
        const pelvis = hips ?? { ...position, y: position.y * pelvisShare };
        view.update(aside === 0 ? pelvis : { ...pelvis, x: pelvis.x + aside }, frame.head, elapsed);
      }
    },
    draw({ time, frame, avatar, inSession, watched, beside, mirror: wanted, savings }) {
      save(savings);
      const inside = inSession || view.view === 'first-person';
      if (avatar) {
        skeleton.show(avatar.jointPositions());
        skeleton.object.position.x = beside;
        avatar.object.position.x = beside;
        avatar.object.visible = watched === null;
        avatar.setOpacity(headLoss.follow(time, frame !== null));
        avatar.setFirstPerson(inside && beside === 0);
      }
      const eyes = inSession && frame ? frame.head : null;
      vignette.show(time, eyes);
      captions.show(time, eyes);
      const beforeIt = inside || view.camera.position.z > 0.1 - mirrorDistance;
      mirror.setVisible(wanted === 'always' || (wanted === 'unless-behind' && beforeIt));
      const camera = inSession ? headsetCamera : view.camera;
      info.reset();
      mirror.reflect(renderer, studio.scene, camera, time);
      count('mirror');
      renderer.render(studio.scene, camera);
      count('scene');
    },
  };
}
