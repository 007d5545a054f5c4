import type { HostedGame } from 'threepoint-rooms/room';
import { isTouchFirst, RoomLinkCard, type ServerState } from 'threepoint-ui';
import { Button, Group, Sentences, Toggle, TypedInput } from 'threepoint-ui/controls';
import type { SeatedGame } from '../match/seated-game';
import type { MatchBarActions, MatchBarState } from './match-controls';
import type { MatchRound } from './match-round';
import { otherPlayers } from './other-players';
import { VoicesBar } from './voices-bar';

interface MatchBarProps {
  readonly game: Pick<SeatedGame<HostedGame>, 'name' | 'roles' | 'bots' | 'rules' | 'option'>;
  readonly actions: MatchBarActions;
  readonly state: MatchBarState;
}

/** This page is no longer in the room. */
const isOut = (round: MatchRound | null): boolean => (round?.ended ?? null) !== null;

/** Before and after a match, while another person could take a seat. */
const isWaitedFor = (round: MatchRound | null): boolean =>
  round !== null && !isOut(round) && round.phase !== 'running' && round.people.some(({ free }) => free);

/** Players and rules, in a section that can be folded. */
const Players = ({ game, actions, state: { round, bots, sound, name, defaultName } }: MatchBarProps) => (
  <details>
    <summary>Players and rules</summary>
    <Sentences class="rules" sentences={round?.rules ?? game.rules(null)} />
    <label class="toggle">
      <span>Your name</span>
      <TypedInput
        type="text"
        maxLength={24}
        autocomplete="nickname"
        aria-label="Your name"
        placeholder={defaultName}
        value={name}
        onChange={({ currentTarget }) => actions.setName(currentTarget.value)}
      />
    </label>
    {game.bots && <Toggle label="Bots take free seats" on={bots} set={actions.setBots} />}
    {game.option && (
      <Toggle
        label={game.option.label}
        on={round?.option ?? false}
        disabled={round?.seat === null || !round?.joined}
        set={actions.setOption}
      />
    )}
    <Toggle label="Sound" on={sound} set={actions.setSound} />
  </details>
);

/** Describes the room, the user's role and the quality of the connection. */
function whereText({ round, room }: MatchBarState): string {
  const name = room ? `Room “${room}”` : 'Your own room';
  if (!round) return `${name} · joining …`;
  // A spectator counts among the spectators, and knows that already.
  const watchers = round.spectators - (round.seat === null ? 1 : 0);
  const watching = watchers > 0 ? `${watchers} ${round.seat === null ? 'more ' : ''}watching` : null;
  return [name, round.role, watching, round.connection].filter(Boolean).join(' · ');
}

/** The score, what is left to play, and the time. */
function Score({ round }: Pick<MatchBarState, 'round'>) {
  const seconds = round ? `${Math.ceil(round.secondsLeft)} s` : '';
  return (
    <div class="row board">
      <output class="score" aria-label="Score">
        {round ? `${round.score} / ${round.of}` : '–'}
      </output>
      <span class="arrows">{round?.remainder}</span>
      <span class="time">{round?.paused ? `${seconds}, paused` : seconds}</span>
    </div>
  );
}

/** The button that starts a match, or that returns to the room after this page has left it. */
function ReadyButton({ actions, state: { round, readyByItself } }: Omit<MatchBarProps, 'game'>) {
  if (isOut(round)) return <Button label="Rejoin" class="primary" onClick={actions.rejoin} />;
  const isReady = round?.ready ?? false;
  const enabled = round?.joined && round.seat !== null && round.phase !== 'running' && !readyByItself;
  return (
    <Button
      label={isReady && enabled ? 'Wait for me' : round?.phase === 'over' ? 'Play again' : 'Ready'}
      class={enabled && !isReady ? 'primary' : ''}
      disabled={!enabled}
      onClick={() => actions.ready(!isReady)}
    />
  );
}

/** The buttons of the current state. What cannot be pressed now keeps its place, so that no other takes it. */
function Buttons({ actions, state }: Omit<MatchBarProps, 'game'>) {
  const { round, mouse } = state;
  const touch = isTouchFirst();
  const isSeated = round !== null && round.seat !== null;
  const hint = round?.hints[touch ? 'touch' : 'mouse'] ?? null;
  return (
    <>
      <div class="row halves">
        <ReadyButton actions={actions} state={state} />
        <Button label="Watch" disabled={!isSeated || !round.joined} onClick={() => actions.sit(null)} />
      </div>
      <Button
        label={mouse ? 'Let the computer play' : touch ? 'Play by touch' : 'Play with the mouse'}
        class={mouse || isOut(round) ? '' : 'primary'}
        hidden={!isSeated || mouse === null || (hint === null && !mouse)}
        disabled={isOut(round)}
        onClick={() => actions.steer(!mouse)}
      />
      {isSeated && mouse === true && !isOut(round) && <p class="hint">{hint}</p>}
    </>
  );
}

/** The seats that are free, and for a spectator the players to follow. */
function Seats({ actions, state: { round, following } }: Omit<MatchBarProps, 'game'>) {
  const free = round && round.phase !== 'running' ? round.people.filter((person) => person.free) : [];
  const followed = round?.seat === null ? otherPlayers(round, false) : null;
  return (
    <>
      {free.length > 0 && (
        <Group label="Seats" class="seats">
          {free.map(({ seat, role }) => (
            <Button
              key={seat}
              label={`Play as ${role.toLowerCase()}`}
              disabled={!round?.joined}
              onClick={() => actions.sit(seat)}
            />
          ))}
        </Group>
      )}
      {followed && (
        <Group label="Camera" class="segments">
          {[{ seat: null, label: 'Free' }, ...followed].map(({ seat, label }) => (
            <Button key={seat} label={label} aria-pressed={seat === following} onClick={() => actions.follow(seat)} />
          ))}
        </Group>
      )}
    </>
  );
}

/** The reason why there are no shared rooms; null: there are, or the state is unknown. */
const serverTexts: Readonly<Record<ServerState, string | null>> = {
  unknown: null,
  asked: null,
  here: null,
  none: 'This page’s host has no threepoint server, so there are no shared rooms.',
  silent: 'The server with the shared rooms does not answer. Try again later.',
};

/** The controls for playing with other people, or the reason why there is no shared room. */
function Company({ game, actions, state: { room, server, round } }: MatchBarProps) {
  // In a room the banner describes the problem with its server.
  const text = room === null ? serverTexts[server] : null;
  return (
    <div class="company">
      <p class="hint" role="status" hidden={text === null}>
        {text}
        {game.bots && server === 'none' && ' You can play alone with bots.'}
      </p>
      {room !== null && isWaitedFor(round) && <RoomLinkCard key={room} game={game.name} room={room} />}
      <div class="row">
        <Button
          label="Play with others"
          hidden={room !== null || text !== null}
          disabled={server !== 'here'}
          onClick={actions.openRoom}
        />
        <Button label="Invite others" hidden={room === null} onClick={actions.invite} />
        <Button label="Ask again" hidden={text === null} onClick={actions.askServer} />
      </div>
    </div>
  );
}

/** Score, seats and settings of a match. */
export function MatchBar({ game, actions, state }: MatchBarProps) {
  const { round } = state;
  const sentence = round?.ended ?? round?.waiting ?? null;
  return (
    <div class="round">
      <Score round={round} />
      <p class="hint">{whereText(state)}</p>
      <Buttons actions={actions} state={state} />
      <p class="waiting" role="status" hidden={sentence === null}>
        {sentence}
      </p>
      <Company game={game} actions={actions} state={state} />
      <Seats actions={actions} state={state} />
      {round && <VoicesBar state={round.voices} room={round} actions={actions.voices} />}
      <Players game={game} actions={actions} state={state} />
    </div>
  );
}
