import { archeryRulesText } from 'threepoint-games/archery';
import { button, element, isTouchFirst, sentenceList, toggle } from 'threepoint-ui';
import type { ActivityPanel } from '../activity/activity';
import type { ActivityContext, StoredActivitySettings } from '../activity/activity-context';
import type { roundOf } from './archery-play';

export type ArcheryRules = Partial<Pick<StoredActivitySettings, 'bowSide' | 'oneHanded' | 'everyHitCounts'>>;

/** A round as the panel shows it. */
export interface ArcheryRound extends ReturnType<typeof roundOf> {
  /** A sentence about what the round waits for; null: it waits for nothing. */
  readonly waiting: string | null;
}

interface ArcheryControls {
  round(): ArcheryRound | null;
  setRules(rules: ArcheryRules): void;
  chooseShooter(shooter: 'mouse' | 'actor'): void;
  restart(): void;
}

const mouseHint = 'Aim with the mouse, hold its button to draw, release it to shoot. Esc puts the arrow back.';
const touchHint = 'Touch the picture to draw, drag to aim, lift to shoot. A second finger puts the arrow back.';

type PanelContext = Pick<ActivityContext, 'settings' | 'headset' | 'inputSource' | 'setSound'>;

/** Hands and rules of archery, in a section that can be folded. */
function createRules(archery: ArcheryControls, context: PanelContext) {
  const rightBow = toggle('Bow in the right hand', (on) => archery.setRules({ bowSide: on ? 'right' : 'left' }));
  const oneHanded = toggle('One hand: hold to draw', (on) => archery.setRules({ oneHanded: on }));
  const everyHit = toggle('Every hit counts', (on) => archery.setRules({ everyHitCounts: on }));
  const sound = toggle('Sound', (on) => context.setSound(on));
  return {
    node: element(
      'details',
      {},
      element('summary', {}, 'Rules and hands'),
      sentenceList(archeryRulesText),
      ...[rightBow, oneHanded, everyHit, sound].map(({ node }) => node),
    ),
    show() {
      const { settings } = context;
      rightBow.input.checked = settings.bowSide === 'right';
      oneHanded.input.checked = settings.oneHanded;
      everyHit.input.checked = settings.everyHitCounts;
      sound.input.checked = settings.sound;
    },
  };
}

/** Score, arrows and time of a round, and the choice of who shoots. */
export function createArcheryPanel(archery: ArcheryControls, context: PanelContext): ActivityPanel {
  const score = element('output', { class: 'score', 'aria-label': 'Score' });
  const arrows = element('span', { class: 'arrows' });
  const time = element('span', { class: 'time' });
  const waiting = element('p', { class: 'waiting', role: 'status' });
  const touch = isTouchFirst();
  const shoot = button(touch ? 'Shoot by touch' : 'Shoot with the mouse', () => archery.chooseShooter('mouse'), {
    class: 'primary',
  });
  const watch = button('Watch', () => archery.chooseShooter('actor'));
  const restart = button('New round', () => archery.restart());
  const hint = element('p', { class: 'hint' }, touch ? touchHint : mouseHint);
  const rules = createRules(archery, context);
  const node = element(
    'div',
    { class: 'round' },
    element('div', { class: 'row board' }, score, arrows, time),
    waiting,
    element('div', { class: 'row' }, shoot, watch, restart),
    hint,
    rules.node,
  );
  return {
    node,
    show() {
      const round = archery.round();
      node.hidden = round === null;
      if (!round) return;
      const { worn } = context.headset;
      const source = context.inputSource;
      score.textContent = `${round.score} / ${round.of}`;
      arrows.textContent = `${round.arrowsLeft} ${round.arrowsLeft === 1 ? 'arrow' : 'arrows'}`;
      time.textContent = `${Math.ceil(round.secondsLeft)} s`;
      // Writing the same text again would make screen readers announce it again.
      if (waiting.textContent !== (round.waiting ?? '')) waiting.textContent = round.waiting;
      waiting.hidden = round.waiting === null;
      restart.classList.toggle('primary', round.over);
      shoot.hidden = worn || source === 'mouse';
      watch.hidden = source === 'actor';
      hint.hidden = source !== 'mouse' || worn;
      rules.show();
    },
  };
}
