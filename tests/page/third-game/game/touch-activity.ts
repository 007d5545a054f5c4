import { Group, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from 'three';
import { allReleased, type Buttons, type HapticPulse, type TrackingFrame } from 'threepoint/core';
import { identity, invertTransform, transformPoint, vec3 } from 'threepoint/math';
import { pulseBothHands, type SimulatedInput } from 'threepoint-games';
import type { Connection } from 'threepoint-rooms/room';
import type { ActivityContext } from '../../../../src/page/activity/activity-context';
import { MatchActivity, type MatchView, openMatch } from '../../../../src/page/people/match/match-activity';
import type { MatchFrame } from '../../../../src/page/people/match/match-frame';
import { MatchPlay } from '../../../../src/page/people/match/match-play';
import type { MatchTask } from '../../../../src/page/people/match/match-runner';
import { PeopleView } from '../../../../src/page/people/view/people-view';
import { disposeTree } from '../../../../src/page/scene/dispose-tree';
import { daylight } from '../../../../src/page/scene/outdoors/daylight';
import type { Quality } from '../../../../src/page/scene/renderer';
import { createSoundStage } from '../../../../src/page/scene/sound/sound-stage';
import { touchGame } from './touch-game';
import type { TouchGame } from './touch-rooms';
import { floorOf, score, targetOf, touchedTarget } from './touch-rules';

/** A match of “Touch the lit targets”. */
export class TouchPlay extends MatchPlay<TouchGame> {
  /** The target that a hand is at; a touch counts when it begins. */
  #at: number | null = null;

  /** Returns the input of a simulated player, whose right hand moves between the lit target and the body. */
  act(time: number): SimulatedInput | null {
    const { newest } = this;
    if (!newest || newest.me === null) return null;
    const lit = targetOf(newest.me, newest.state.players[newest.me]?.lit ?? 0);
    const target = transformPoint(invertTransform(floorOf(newest.me)), lit);
    const way = 0.5 - 0.5 * Math.cos(6 * time);
    const position = vec3(0.2 + way * (target.x - 0.2), 1 + way * (target.y - 1), -0.2 + way * (target.z + 0.2));
    const hand = { position, orientation: identity, tracking: 'tracked' } as const;
    const head = { position: vec3(0, 1.6, 0), orientation: identity, tracking: 'tracked' } as const;
    const frame = { time, head, leftHand: null, rightHand: hand } as TrackingFrame;
    return { frame, buttons: { left: allReleased, right: allReleased } };
  }

  protected override playHands(connection: Connection<TouchGame>, { leftHand, rightHand }: TrackingFrame, _: Buttons) {
    const seat = connection.room?.mySeat ?? 0;
    const arenaFromFloor = connection.arenaFromFloor(seat);
    const hands = [leftHand, rightHand].map((hand) => hand && transformPoint(arenaFromFloor, hand.position));
    const target = touchedTarget(seat, hands);
    const isNew = target !== null && target !== this.#at;
    this.#at = target;
    if (isNew) connection.sendAction({ type: 'touch', target });
    return isNew ? pulseBothHands(0.3, 0.03) : ([] as readonly HapticPulse[]);
  }

  protected override completeFrame(shared: MatchFrame<TouchGame>): MatchFrame<TouchGame> {
    return shared;
  }
}

/** Four targets in front of each player; the lit ones glow. */
class TouchView implements MatchView<TouchGame, MatchFrame<TouchGame>> {
  readonly people;
  readonly sound = createSoundStage(new Map());
  readonly #object = new Group();
  readonly #quality: Quality;
  readonly #targets = [0, 1].map((seat) =>
    [0, 1, 2, 3].map((target) => {
      const mesh = new Mesh(new SphereGeometry(0.06), new MeshStandardMaterial({ color: '#456' }));
      mesh.position.copy(targetOf(seat, target));
      return mesh;
    }),
  );

  constructor(quality: Quality) {
    this.#quality = quality;
    this.people = new PeopleView(touchGame, quality);
    this.#object.add(this.people.names, ...this.#targets.flat());
  }

  placed: MatchView<TouchGame, MatchFrame<TouchGame>>['placed'] = (floorFromArena) => {
    this.#object.position.copy(floorFromArena.position);
    this.#object.quaternion.copy(floorFromArena.orientation);
    const shadows = { middle: new Vector3(), halfSize: 3 };
    const sun = { towardsSun: new Vector3(9, 11, 1.5), sunIntensity: 2.6, skyIntensity: 0.9, groundColor: '#8a7a5a' };
    const lighting = daylight({ quality: this.#quality, ...sun, shadows }, floorFromArena);
    return { object: this.#object, scenery: [], lighting };
  };

  show: MatchView<TouchGame, MatchFrame<TouchGame>>['show'] = (scene) => {
    this.people.show(scene, scene.head.position.y);
    for (const [seat, targets] of this.#targets.entries()) {
      for (const [target, { material }] of targets.entries()) {
        material.emissive.set(scene.state.players[seat]?.lit === target ? '#fa3' : '#000');
      }
    }
  };

  dispose(): void {
    this.sound.dispose();
    this.people.dispose();
    disposeTree(this.#object);
  }
}

const camera = { offset: { x: 0, y: 0.6, z: 3 }, aim: { x: 0, y: 0.2, z: -1 }, fovDegrees: 50 };
const scene = { 'third-person': camera, front: { ...camera, offset: { x: 0, y: 0.4, z: -2.5 } } };

export class TouchActivity extends MatchActivity<TouchGame, MatchFrame<TouchGame>, TouchPlay> {
  override act(time: number): SimulatedInput | null {
    return this.play.act(time);
  }

  override probe() {
    const { newest } = this.play;
    const connection = this.play.status.phase;
    return (
      newest && { name: 'touch' as const, ...newest.state, seat: newest.me, score: score(newest.state), connection }
    );
  }
}

export async function openTouch(context: ActivityContext): Promise<TouchActivity> {
  return new TouchActivity(await openMatch(touchGame, context), {
    game: touchGame,
    view: new TouchView(context.quality),
    scenes: { player: scene, spectator: { ...scene, free: true }, middle: vec3(0, 1, 0) },
    acting: () => context.place === null && context.settings.actor && !context.headset.worn,
    createPlay: (options) => new TouchPlay(touchGame, options),
  });
}

export const touchTask: MatchTask<TouchGame> = {
  // reason: a name of the registry in which this game is listed
  name: 'touch' as MatchTask<TouchGame>['name'],
  figures: touchGame.figures,
  taskEvents({ type, player }, me, time) {
    if (type !== 'touched') return [];
    return player === me ? [{ type: 'shot' }, { type: 'hit', time, points: 1 }] : [{ type: 'catch', time, points: 1 }];
  },
};
