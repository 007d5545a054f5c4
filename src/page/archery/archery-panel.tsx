import { archeryRulesText } from 'threepoint-games/archery';
import { isTouchFirst } from 'threepoint-ui';
import { Button, Sentences, Toggle } from 'threepoint-ui/controls';
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

interface PanelProps {
  readonly archery: ArcheryControls;
  readonly context: PanelContext;
}

/** Hands and rules of archery, in a section that can be folded. */
const Rules = ({ archery, context }: PanelProps) => (
  <details>
    <summary>Rules and hands</summary>
    <Sentences class="rules" sentences={archeryRulesText} />
    <Toggle
      label="Bow in the right hand"
      on={context.settings.bowSide === 'right'}
      set={(on) => archery.setRules({ bowSide: on ? 'right' : 'left' })}
    />
    <Toggle
      label="One hand: hold to draw"
      on={context.settings.oneHanded}
      set={(oneHanded) => archery.setRules({ oneHanded })}
    />
    <Toggle
      label="Every hit counts"
      on={context.settings.everyHitCounts}
      set={(everyHitCounts) => archery.setRules({ everyHitCounts })}
    />
    <Toggle label="Sound" on={context.settings.sound} set={(on) => context.setSound(on)} />
  </details>
);

/** Score, arrows and time of a round, and the choice of who shoots. */
function Round({ round, archery, context }: PanelProps & { readonly round: ArcheryRound }) {
  const { worn } = context.headset;
  const source = context.inputSource;
  const touch = isTouchFirst();
  return (
    <div class="round">
      <div class="row board">
        <output class="score" aria-label="Score">{`${round.score} / ${round.of}`}</output>
        <span class="arrows">{`${round.arrowsLeft} ${round.arrowsLeft === 1 ? 'arrow' : 'arrows'}`}</span>
        <span class="time">{`${Math.ceil(round.secondsLeft)} s`}</span>
      </div>
      <div class="row">
        <Button
          label={touch ? 'Shoot by touch' : 'Shoot with the mouse'}
          class={source === 'mouse' ? '' : 'primary'}
          hidden={worn}
          disabled={source === 'mouse'}
          onClick={() => archery.chooseShooter('mouse')}
        />
        <Button label="Watch" disabled={source === 'actor'} onClick={() => archery.chooseShooter('actor')} />
        <Button label="New round" class={round.over ? 'primary' : ''} onClick={() => archery.restart()} />
      </div>
      <p class="waiting" role="status" hidden={round.waiting === null}>
        {round.waiting}
      </p>
      {source === 'mouse' && !worn && <p class="hint">{touch ? touchHint : mouseHint}</p>}
      <Rules archery={archery} context={context} />
    </div>
  );
}

/** Creates archery's part of the play bar. Between two rounds it shows the last one, so that what is unfolded stays. */
export function createArcheryPanel(archery: ArcheryControls, context: PanelContext): ActivityPanel {
  let shown: ArcheryRound | null = null;
  return () => {
    shown = archery.round() ?? shown;
    return shown && <Round round={shown} archery={archery} context={context} />;
  };
}
