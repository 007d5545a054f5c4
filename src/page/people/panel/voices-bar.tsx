import { Button, Group, Toggle } from 'threepoint-ui/controls';
import { seatLooks } from '../view/seat-looks';
import { consentText, type VoicesState } from '../voices/voices-state';
import type { MatchBarActions } from './match-controls';
import { hideLabel, muteLabel, type OtherPlayer, otherPlayers, type SeatRow } from './other-players';

/** The mark of a station in its colour. */
function SeatMark({ station }: Pick<OtherPlayer, 'station'>) {
  const look = seatLooks[station];
  return (
    <span class="seat-mark" style={{ background: look?.color, color: look?.ink }}>
      {look?.mark}
    </span>
  );
}

interface PersonProps {
  readonly player: OtherPlayer;
  readonly actions: MatchBarActions['voices'];
}

/** Another player, with the buttons that mute and hide them. */
const Person = ({ player, actions }: PersonProps) => (
  <li>
    <SeatMark station={player.station} />
    <p class="who">
      <span>{player.name}</span>
      <span class="hint">{player.status}</span>
    </p>
    <div class="buttons">
      <Button
        label={muteLabel(player)}
        aria-label={`${muteLabel(player)} ${player.label}`}
        hidden={player.muting === 'none'}
        disabled={player.muting === 'off'}
        onClick={() => actions.silence(player.seat, !player.silenced)}
      />
      <Button
        label={hideLabel(player)}
        aria-label={`${hideLabel(player)} ${player.label}`}
        onClick={() => actions.hide(player.seat, !player.hidden)}
      />
    </div>
  </li>
);

interface VoicesProps {
  readonly state: VoicesState;
  readonly actions: MatchBarActions['voices'];
}

/** The consent text with the buttons that join or decline. */
const Consent = ({ state: { relay, relayOnly }, actions }: VoicesProps) => (
  <Group label="Before you join voice chat" class="consent">
    <p>{consentText}</p>
    {relay ? (
      <Toggle label="Hide my address (relay only)" on={relayOnly} set={actions.relayOnly} />
    ) : (
      <p class="hint">
        This server has no relay, so your address cannot be hidden. Do not join if you do not want that.
      </p>
    )}
    <div class="row">
      <Button label="Join, muted" class="primary" onClick={actions.join} />
      <Button label="Not now" onClick={() => actions.ask(false)} />
    </div>
  </Group>
);

interface VoicesBarProps extends VoicesProps {
  /** The people in the room, and the user's seat; null: a spectator. */
  readonly room: { readonly seat: number | null; readonly people: readonly SeatRow[] };
}

/** Talking with the others, and the list of them. */
export function VoicesBar({ state, room, actions }: VoicesBarProps) {
  const { phase, muted, microphoneMissing, message } = state;
  const isIn = phase === 'in';
  const others = otherPlayers(room, isIn);
  if (phase === 'none' && others.length === 0) return null;
  const sentence = phase === 'none' ? '' : (message ?? (isIn && muted ? 'You are muted.' : ''));
  return (
    <Group label="Voices" class="voices">
      {phase === 'asked' && <Consent state={state} actions={actions} />}
      <div class="row">
        <Button
          label={phase === 'joining' ? 'Joining voice chat …' : 'Talk with the others'}
          hidden={phase !== 'off' && phase !== 'joining'}
          disabled={phase === 'joining'}
          onClick={() => actions.ask(true)}
        />
        <Button
          label={microphoneMissing ? 'Find a microphone' : muted ? 'Unmute me (T)' : 'Mute me (T)'}
          class={isIn && !muted ? 'primary' : ''}
          aria-keyshortcuts="t"
          aria-pressed={!muted}
          hidden={!isIn || room.seat === null}
          onClick={() => actions.mute(!muted)}
        />
        <Button label="Leave voice chat" hidden={!isIn} onClick={actions.leave} />
      </div>
      <p class="hint" role="status" hidden={sentence === ''}>
        {sentence}
      </p>
      {others.length > 0 && (
        <ul class="people" aria-label="Other players">
          {others.map((player) => (
            <Person key={player.seat} player={player} actions={actions} />
          ))}
        </ul>
      )}
    </Group>
  );
}
