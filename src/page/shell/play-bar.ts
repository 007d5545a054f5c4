import { button, element } from 'threepoint-ui/element';
import { archeryRulesText, rulesList } from 'threepoint-ui/rules';
import { toggle } from 'threepoint-ui/toggle';
import { type BallBarActions, type BallBarState, createBallBar } from '../ball/ball-bar';

/** What people do here: look at themselves in the studio, or play. */
export const activityNames = ['studio', 'archery', 'ball'] as const;
export type ActivityName = (typeof activityNames)[number];

/** Who may be chosen to shoot on the desktop: the built-in archer or the mouse. */
export type ChosenShooter = 'actor' | 'mouse';

/** Who shoots there: one of these, the person who holds the (emulated) headset, or no one while a recording replays. */
export type Shooter = ChosenShooter | 'headset' | 'recording';

/** A round as the bar shows it. */
export interface RoundState {
  readonly score: number;
  readonly of: number;
  readonly arrowsLeft: number;
  readonly secondsLeft: number;
  readonly over: boolean;
  /** What the round waits for, in a sentence; null: for nothing. */
  readonly waiting: string | null;
}

export interface PlayState {
  readonly activity: ActivityName;
  /** Loading the range. */
  readonly arriving: boolean;
  readonly round: RoundState | null;
  /** The ball game; null elsewhere. */
  readonly ball: BallBarState | null;
  readonly shooter: Shooter;
  readonly bowSide: 'left' | 'right';
  readonly oneHanded: boolean;
  readonly everyHitCounts: boolean;
  readonly sound: boolean;
  readonly inSession: boolean;
}

export interface PlayActions {
  goTo(activity: ActivityName): void;
  restart(): void;
  chooseShooter(shooter: ChosenShooter): void;
  setBowSide(side: 'left' | 'right'): void;
  setOneHanded(on: boolean): void;
  setEveryHitCounts(on: boolean): void;
  setSound(on: boolean): void;
  readonly ball: BallBarActions;
}

export interface PlayBar {
  show(state: PlayState): void;
  /** What is heard, in words; stays until the next one, and is announced. */
  caption(text: string): void;
}

const activityTexts: Readonly<Record<ActivityName, string>> = {
  studio: 'Mirror',
  archery: 'Archery',
  ball: 'Ball game',
};

const mouseHint = 'Aim with the mouse, hold its button to draw, let go to shoot. Esc puts the arrow back.';

/** Hands and rules of archery, folded away. */
function createArcherySettings(actions: PlayActions) {
  const rightBow = toggle('Bow in the right hand', (on) => actions.setBowSide(on ? 'right' : 'left'));
  const oneHanded = toggle('One hand: hold to draw', (on) => actions.setOneHanded(on));
  const everyHit = toggle('Every hit counts', (on) => actions.setEveryHitCounts(on));
  const sound = toggle('Sound', (on) => actions.setSound(on));
  return {
    node: element(
      'details',
      {},
      element('summary', {}, 'Rules and hands'),
      rulesList(archeryRulesText),
      ...[rightBow, oneHanded, everyHit, sound].map(({ node }) => node),
    ),
    show(state: PlayState) {
      rightBow.input.checked = state.bowSide === 'right';
      oneHanded.input.checked = state.oneHanded;
      everyHit.input.checked = state.everyHitCounts;
      sound.input.checked = state.sound;
    },
  };
}

/** Score, arrows and time of a round, and who shoots. */
function createArcheryBar(actions: PlayActions) {
  const score = element('output', { class: 'score', 'aria-label': 'Score' });
  const arrows = element('span', { class: 'arrows' });
  const time = element('span', { class: 'time' });
  const waiting = element('p', { class: 'waiting', role: 'status' });
  const shoot = button('Shoot with the mouse', () => actions.chooseShooter('mouse'), { class: 'primary' });
  const watch = button('Watch', () => actions.chooseShooter('actor'));
  const restart = button('New round', () => actions.restart());
  const hint = element('p', { class: 'hint' }, mouseHint);
  const settings = createArcherySettings(actions);
  const node = element(
    'div',
    { class: 'round' },
    element('div', { class: 'row board' }, score, arrows, time),
    waiting,
    element('div', { class: 'row' }, shoot, watch, restart),
    hint,
    settings.node,
  );
  return {
    node,
    show(state: PlayState) {
      const { round, shooter, inSession } = state;
      node.hidden = round === null;
      if (!round) return;
      score.textContent = `${round.score} / ${round.of}`;
      arrows.textContent = `${round.arrowsLeft} ${round.arrowsLeft === 1 ? 'arrow' : 'arrows'}`;
      time.textContent = `${Math.ceil(round.secondsLeft)} s`;
      // Said again, it would be announced again.
      if (waiting.textContent !== (round.waiting ?? '')) waiting.textContent = round.waiting;
      waiting.hidden = round.waiting === null;
      restart.classList.toggle('primary', round.over);
      shoot.hidden = inSession || shooter === 'mouse';
      watch.hidden = shooter === 'actor';
      hint.hidden = shooter !== 'mouse' || inSession;
      settings.show(state);
    },
  };
}

/** The choice of what to do, and in a game its score and settings; below the masthead. */
export function createPlayBar(region: HTMLElement, actions: PlayActions): PlayBar {
  const activities = activityNames.map((name) => ({
    name,
    node: button(activityTexts[name], () => actions.goTo(name), { 'aria-pressed': 'false' }),
  }));
  const archery = createArcheryBar(actions);
  const ball = createBallBar(actions.ball, (on) => actions.setSound(on));
  const captions = element('p', { class: 'caption', role: 'status', 'aria-live': 'polite' });
  const choice = { class: 'segments', role: 'group', 'aria-label': 'What to do' };
  region.append(element('div', choice, ...activities.map(({ node }) => node)), archery.node, ball.node, captions);
  return {
    show(state) {
      for (const { name, node } of activities) {
        node.setAttribute('aria-pressed', String(name === state.activity));
        node.disabled = state.arriving;
      }
      captions.hidden = state.round === null && state.ball === null;
      archery.show(state);
      ball.show(state.ball, state.sound);
    },
    caption(text) {
      captions.textContent = text;
    },
  };
}
