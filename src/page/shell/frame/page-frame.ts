import { ReplayedBody } from 'threepoint';
import {
  type AvatarPose,
  firstLine,
  type HandShape,
  type Mutable,
  makeHandShape,
  reasonOf,
  type TrackingFrame,
} from 'threepoint/core';
import type { Side } from 'threepoint/math';
import { handShapeFromButtons } from 'threepoint/three';
import { defaultSavings } from 'threepoint/webxr';
import type { Controls } from '../controls/controls';
import type { PageParts } from '../page-parts';
import type { PassthroughHost } from '../session/passthrough-host';
import type { Picture } from '../stage';
import type { FrameParts } from './frame-loop';

export interface PageFrameOptions extends PageParts {
  readonly controls: Controls;
  readonly passthrough: PassthroughHost;
}

/** How far to the right of its user the avatar stands that is seen from beside [m]. */
const besideDistance = 1.2;

/** One frame of this page, part by part. */
export class PageFrame implements FrameParts<XRFrame> {
  readonly #options: PageFrameOptions;
  readonly #replayed: ReplayedBody;
  readonly #fingers: Record<Side, HandShape | null> = { left: null, right: null };
  readonly #drawn: Partial<Mutable<AvatarPose>> = { fingers: this.#fingers };
  readonly #shapes = { left: makeHandShape(), right: makeHandShape() };
  /** The newest tracked frame as the body has it. */
  #embodied: TrackingFrame | null = null;
  #count = 0;
  #lastFault = '';
  /** Callbacks that wait for the next picture. */
  #waiting: (() => void)[] = [];

  constructor(options: PageFrameOptions) {
    this.#options = options;
    this.#replayed = new ReplayedBody(options.body, options.recorder);
  }

  /** Frames drawn since the page opened. */
  get count(): number {
    return this.#count;
  }

  /**
   * Resolves when the next picture has been drawn, in the window or in a session: while one lasts, headsets let their
   * windows rest.
   */
  nextPicture(): Promise<void> {
    return new Promise((resolve) => this.#waiting.push(resolve));
  }

  track(time: number, deviceFrame: XRFrame | undefined): TrackingFrame | null {
    const { source, study, headset, timing, passthrough } = this.#options;
    // A study measures all of its rounds at one rate.
    if (deviceFrame && !study.run) headset.observeFrame(time, timing.lastMs / 1000);
    const frame = source.read(time, deviceFrame);
    passthrough.update(deviceFrame, time);
    return frame;
  }

  observe(frame: TrackingFrame): void {
    const { recorder, controls, headset, activities, source, degradation } = this.#options;
    recorder.observe(frame);
    controls.observe(frame);
    this.#embodied = degradation.apply(frame);
    headset.buzz(activities.play(this.#embodied, source.buttons));
  }

  estimate(frame: TrackingFrame | null): AvatarPose | null {
    const { source, degradation, headset, body } = this.#options;
    if (!frame) degradation.reset();
    const embodied = frame && this.#embodied;
    if (!headset.worn) return this.#replayed.update(embodied, source.standIn);
    this.#replayed.stop();
    return body.update(embodied);
  }

  skin(pose: AvatarPose): void {
    const { avatar, activities, mocap, difference, body } = this.#options;
    const frame = this.#embodied;
    if (!frame) return;
    difference.observe(frame, pose, body.calibration);
    this.#bendFingers('left', frame);
    this.#bendFingers('right', frame);
    avatar.current?.setMouth(activities.current?.mouth ?? 0);
    avatar.current?.setPose(this.#withFingers(pose), frame.time);
    activities.current?.send?.(frame, pose, this.#fingers);
    mocap.frame(frame, pose);
  }

  render(time: number, frame: TrackingFrame | null): void {
    const { study, stage, activities } = this.#options;
    this.#count += 1;
    if (this.#waiting.length > 0) for (const tell of this.#waiting.splice(0)) tell();
    study.run?.frame(time, frame);
    this.#point(frame);
    this.#turn(time);
    const shot = this.#shot(time, frame);
    stage.look(shot);
    activities.show(time, frame);
    stage.draw(shot);
  }

  fail(error: unknown): void {
    const text = firstLine(reasonOf(error));
    if (text !== this.#lastFault) this.#options.notices.show('error', `A frame could not be drawn: ${text}`);
    this.#lastFault = text;
  }

  /**
   * What a hand holds closes it; else its fingers are as tracked, or as the buttons of a hand say whose fingers no
   * device sees.
   */
  #bendFingers(side: Side, { fingers, leftHand, rightHand }: TrackingFrame): void {
    const { activities, source, avatar } = this.#options;
    const target = this.#shapes[side];
    const wrist = side === 'left' ? leftHand : rightHand;
    const hand = avatar.current?.handGeometry(side) ?? null;
    const held = wrist && activities.grasp(side, wrist, hand, target) ? target : null;
    const shape = held ?? (fingers ? fingers[side] : handShapeFromButtons(source.buttons[side], target));
    this.#fingers[side] = shape;
  }

  /** Returns the pose with the drawn fingers, in an object that the next frame overwrites. */
  #withFingers({ head, leftHand, rightHand, body, feet }: AvatarPose): AvatarPose {
    const drawn = this.#drawn;
    drawn.head = head;
    drawn.leftHand = leftHand;
    drawn.rightHand = rightHand;
    drawn.body = body;
    drawn.feet = feet;
    return drawn as AvatarPose;
  }

  /** Hands behind a menu of the device point at nothing. */
  #point(frame: TrackingFrame | null): void {
    const { headset, controls } = this.#options;
    if (headset.visibility === 'visible') controls.point(frame);
  }

  #turn(time: number): void {
    const { headset, stage, activities } = this.#options;
    if (headset.commands?.mute.take()) activities.current?.toggleMuted?.();
    // A room that is seen cannot be turned.
    if (!headset.passthrough && headset.turnIfAsked()) stage.vignette.close(time);
  }

  #shot(time: number, frame: TrackingFrame | null): Picture {
    const { avatar, headset, activities, mocap, settings, study } = this.#options;
    const besideUser = settings.beside && headset.passthrough !== null && activities.current === null;
    return {
      time,
      beside: besideUser ? besideDistance : 0,
      aside: mocap.aside,
      frame,
      avatar: avatar.current,
      inSession: headset.worn,
      watched: activities.current?.watched ?? null,
      mirror: this.#mirror(),
      // All pictures of a study are alike.
      savings: study.run ? defaultSavings : headset.savings,
    };
  }

  #mirror(): Picture['mirror'] {
    const { settings, activities } = this.#options;
    return settings.mirror ? activities.mirror : 'never';
  }
}
