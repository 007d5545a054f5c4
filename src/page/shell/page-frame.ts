import {
  type AvatarPose,
  firstLine,
  type HandShape,
  type Mutable,
  makeHandShape,
  reasonOf,
  type TrackingFrame,
} from 'threepoint/core';
import { defaultSavings, ReplayedBody } from 'threepoint/internal';
import { GazeChoice, handShapeFromButtons } from 'threepoint/internal/three';
import type { Side } from 'threepoint/math';
import { showsIdleMotion } from '../activity/activity-context';
import type { FrameParts } from './frame-loop';
import type { InputParts } from './input/input-parts';
import type { Controls } from './panels/controls';
import type { PassthroughHost } from './stage/passthrough-host';
import type { Picture } from './stage/stage';

/** How far to the right of its user the avatar stands that is seen from beside [m]. */
const besideDistance = 1.2;

/** One frame of this page, part by part. */
export class PageFrame implements FrameParts<XRFrame> {
  readonly #parts: InputParts;
  readonly #controls: Controls;
  readonly #passthrough: PassthroughHost;
  readonly #replayed: ReplayedBody;
  readonly #fingers: Record<Side, HandShape | null> = { left: null, right: null };
  readonly #solved: Partial<Mutable<TrackingFrame>> = { fingers: this.#fingers };
  readonly #shapes = { left: makeHandShape(), right: makeHandShape() };
  readonly #gaze = new GazeChoice();
  /** The newest tracked frame as the body has it. */
  #embodied: TrackingFrame | null = null;
  #count = 0;
  #lastFault = '';
  /** Callbacks that wait for the next picture. */
  #waiting: (() => void)[] = [];

  constructor(parts: InputParts, controls: Controls, passthrough: PassthroughHost) {
    this.#parts = parts;
    this.#controls = controls;
    this.#passthrough = passthrough;
    this.#replayed = new ReplayedBody(parts.body, parts.recorder);
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
    const { source, study, headset, timing } = this.#parts;
    // A study measures all of its rounds at one rate.
    if (deviceFrame && !study.run) headset.observeFrame(time, timing.lastMs / 1000);
    const frame = source.read(time, deviceFrame);
    this.#passthrough.update(deviceFrame, time);
    return frame;
  }

  observe(frame: TrackingFrame): void {
    const { recorder, headset, activities, source, degradation } = this.#parts;
    recorder.observe(frame);
    this.#controls.observe(frame);
    this.#embodied = degradation.apply(frame);
    headset.buzz(activities.play(this.#embodied, source.buttons));
  }

  estimate(frame: TrackingFrame | null): AvatarPose | null {
    const { source, degradation } = this.#parts;
    if (!frame) degradation.reset();
    return this.#replayed.update(frame && this.#embodied && this.#withFingers(this.#embodied), source.standIn);
  }

  skin(pose: AvatarPose): void {
    const { tracker, body, activities, mocap, difference } = this.#parts;
    const frame = this.#embodied;
    if (!frame) return;
    difference.observe(frame, pose, body.calibration);
    tracker.avatar?.setMouth(activities.current?.mouth ?? 0);
    tracker.avatar?.setIdleMotion(showsIdleMotion(this.#parts, activities.inputSource));
    tracker.draw(frame.time);
    activities.current?.send?.(frame, pose, this.#fingers);
    mocap.frame(frame, pose);
  }

  render(time: number, frame: TrackingFrame | null): void {
    const { study, stage, activities, gazeTargets } = this.#parts;
    this.#count += 1;
    if (this.#waiting.length > 0) for (const tell of this.#waiting.splice(0)) tell();
    study.run?.frame(time, frame);
    this.#point(frame);
    this.#turn(time);
    const shot = this.#shot(time, frame);
    stage.look(shot);
    // A spectator has no body here.
    const body = shot.watched ? null : frame;
    if (body) gazeTargets.add(this, body.head.position);
    activities.show(time, frame);
    if (body) this.#look(body);
    gazeTargets.clear();
    stage.draw(shot);
  }

  /** Turns the eyes of the user's avatar to what its face points to: at the desktop also the viewer. */
  #look({ head }: TrackingFrame): void {
    const { tracker, headset, stage, gazeTargets } = this.#parts;
    if (!headset.worn) gazeTargets.add(stage.view, stage.view.camera.position);
    tracker.avatar?.setGaze(this.#gaze.choose(gazeTargets, head));
  }

  fail(error: unknown): void {
    const text = firstLine(reasonOf(error));
    if (text !== this.#lastFault) this.#parts.notices.show('error', `A frame could not be drawn: ${text}`, 'frame');
    this.#lastFault = text;
  }

  /**
   * What a hand holds closes it; else its fingers are as tracked, or as the buttons of a hand say whose fingers no
   * device sees.
   */
  #bendFingers(side: Side, { fingers, leftHand, rightHand }: TrackingFrame): void {
    const { activities, source, tracker } = this.#parts;
    const target = this.#shapes[side];
    const wrist = side === 'left' ? leftHand : rightHand;
    const hand = tracker.avatar?.handGeometry(side) ?? null;
    const held = wrist && activities.grasp(side, wrist, hand, target) ? target : null;
    const shape = held ?? (fingers ? fingers[side] : handShapeFromButtons(source.buttons[side], target));
    this.#fingers[side] = shape;
  }

  /** Returns the frame with the drawn fingers, in an object that the next frame overwrites. */
  #withFingers(frame: TrackingFrame): TrackingFrame {
    this.#bendFingers('left', frame);
    this.#bendFingers('right', frame);
    const solved = this.#solved;
    solved.time = frame.time;
    solved.head = frame.head;
    solved.leftHand = frame.leftHand;
    solved.rightHand = frame.rightHand;
    solved.deviceBody = frame.deviceBody;
    return solved as TrackingFrame;
  }

  /** Hands behind a menu of the device point at nothing. */
  #point(frame: TrackingFrame | null): void {
    if (this.#parts.headset.visibility === 'visible') this.#controls.point(frame);
  }

  #turn(time: number): void {
    const { headset, stage, activities } = this.#parts;
    if (headset.commands?.mute.take()) activities.current?.toggleMuted?.();
    // A room that is seen cannot be turned.
    if (!headset.passthrough && headset.turnIfAsked()) stage.vignette.close(time);
  }

  #shot(time: number, frame: TrackingFrame | null): Picture {
    const { tracker, headset, activities, mocap, settings, study } = this.#parts;
    const besideUser = settings.beside && headset.passthrough !== null && activities.current === null;
    return {
      time,
      beside: besideUser ? besideDistance : 0,
      span: mocap.span,
      frame,
      avatar: tracker.avatar,
      inSession: headset.worn,
      watched: activities.current?.watched ?? null,
      mirror: this.#mirror(),
      // All pictures of a study are alike.
      savings: study.run ? defaultSavings : headset.savings,
    };
  }

  #mirror(): Picture['mirror'] {
    const { settings, activities } = this.#parts;
    return settings.mirror ? activities.mirror : 'never';
  }
}
