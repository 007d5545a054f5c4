import type { HostedGame } from 'threepoint-rooms/room';
import { button, createRoomLink, element, isTouchFirst, type ServerState, sentenceList, toggle } from 'threepoint-ui';
import type { SeatedGame } from '../match/seated-game';
import type { MatchRound } from './match-round';
import { otherPlayers } from './other-players';
import { createVoicesBar, type VoicesBarActions } from './voices-bar';

/** A match as the bar shows it. */
export interface MatchBarState {
  /** null: not in the room yet. */
  readonly round: MatchRound | null;
  /** null: in this page alone. */
  readonly room: string | null;
  /** The state of the server, which hosts shared rooms. */
  readonly server: ServerState;
  readonly bots: boolean;
  /** A simulated player moves the user's body: no person can be asked. */
  readonly acting: boolean;
  /** The mouse moves the user's body; null: it cannot, because a headset is worn or an emulated one is steered. */
  readonly mouse: boolean | null;
  readonly name: string;
  /** The name that others see if the player gave none. */
  readonly defaultName: string;
  /** The seat that a spectator's camera follows; null: the camera is free. */
  readonly following: number | null;
}

/** What the bar has from its game. */
export type GameOnBar = Pick<SeatedGame<HostedGame>, 'name' | 'roles' | 'bots' | 'rules' | 'option'>;

export interface MatchBarActions {
  ready(on: boolean): void;
  setOption(on: boolean): void;
  sit(seat: number | null): void;
  setBots(on: boolean): void;
  setName(name: string): void;
  /** Opens a room that other people can join. */
  openRoom(): void;
  /** Asks for the server again. */
  askServer(): void;
  /** Shows the invitation to this room. */
  invite(): void;
  /** Rejoins the room that this page is no longer in. */
  rejoin(): void;
  /** The camera of a spectator: with a player, or null: free. */
  follow(seat: number | null): void;
  /** Lets the mouse or the simulated player move the user's body. */
  steer(on: boolean): void;
  readonly voices: VoicesBarActions;
}

/** This page is no longer in the room. */
const isOut = (round: MatchRound | null): boolean => (round?.ended ?? null) !== null;

/** Before and after a match, while another person could take a place. */
const isWaitedFor = (round: MatchRound | null): boolean =>
  round !== null && !isOut(round) && round.phase !== 'running' && round.people.some(({ free }) => free);

/** A button for a seat; null: for none. */
interface Offer {
  readonly seat: number | null;
  readonly label: string;
  readonly act: () => void;
  readonly pressed?: boolean;
}

/** A row of buttons that is rebuilt when its offers change. */
function createOffers(attributes: Record<string, string>) {
  const node = element('div', attributes);
  let shown = '';
  return {
    node,
    show(offers: readonly Offer[], disabled = false) {
      const key = JSON.stringify([offers, disabled]);
      node.hidden = offers.length === 0;
      if (key === shown) return;
      shown = key;
      node.replaceChildren(
        ...offers.map(({ label, act, pressed }) =>
          button(label, act, { disabled, ...(pressed !== undefined && { 'aria-pressed': String(pressed) }) }),
        ),
      );
    },
  };
}

/** Players and rules, in a section that can be folded. */
function createPlayers(game: GameOnBar, actions: MatchBarActions, setSound: (on: boolean) => void) {
  const bots = toggle('Bots take free places', actions.setBots);
  const option = toggle(game.option?.label ?? '', actions.setOption);
  option.node.hidden = game.option === undefined;
  bots.node.hidden = !game.bots;
  const sound = toggle('Sound', setSound);
  const name = element('input', { type: 'text', maxlength: 24, autocomplete: 'nickname', 'aria-label': 'Your name' });
  name.addEventListener('change', () => actions.setName(name.value));
  const rules = element('div');
  let rulesShown = '';
  const node = element(
    'details',
    {},
    element('summary', {}, 'Players and rules'),
    rules,
    element('label', { class: 'toggle' }, element('span', {}, 'Your name'), name),
    bots.node,
    option.node,
    sound.node,
  );
  return {
    node,
    show({ round, bots: botsOn, name: given, defaultName }: MatchBarState, soundOn: boolean) {
      const sentences = round?.rules ?? game.rules(null);
      if (sentences.join() !== rulesShown) {
        rulesShown = sentences.join();
        rules.replaceChildren(sentenceList(sentences));
      }
      bots.input.checked = botsOn;
      option.input.checked = round?.option ?? false;
      option.input.disabled = round?.seat === null || isOut(round);
      sound.input.checked = soundOn;
      name.placeholder = defaultName;
      if (document.activeElement !== name) name.value = given;
    },
  };
}

/** Describes the room, the user's role and the quality of the connection. */
function whereText({ round, room }: MatchBarState): string {
  const place = room ? `Room “${room}”` : 'Your own room';
  if (!round) return `${place} · joining …`;
  // A spectator counts among the spectators, and knows that already.
  const watchers = round.spectators - (round.seat === null ? 1 : 0);
  const watching = watchers > 0 ? `${watchers} ${round.seat === null ? 'more ' : ''}watching` : null;
  return [place, round.role, watching, round.connection].filter(Boolean).join(' · ');
}

/** The score, what is left to play, and the time. */
function createScore() {
  const score = element('output', { class: 'score', 'aria-label': 'Score' });
  const left = element('span', { class: 'arrows' });
  const time = element('span', { class: 'time' });
  return {
    node: element('div', { class: 'row board' }, score, left, time),
    show(round: MatchRound | null): void {
      score.textContent = round ? `${round.score} / ${round.of}` : '–';
      left.textContent = round?.remainder ?? '';
      const seconds = round ? `${Math.ceil(round.secondsLeft)} s` : '';
      time.textContent = round?.paused ? `${seconds}, paused` : seconds;
    },
  };
}

/** The buttons of the current state. If this page is no longer in the room, only the way back is enabled. */
function createButtons(actions: MatchBarActions) {
  let isReady = false;
  const ready = button('Ready', () => actions.ready(!isReady), { class: 'primary' });
  const rejoin = button('Rejoin', actions.rejoin, { class: 'primary' });
  const watch = button('Watch', () => actions.sit(null));
  const touch = isTouchFirst();
  const steer = button(touch ? 'Play by touch' : 'Play with the mouse', () => actions.steer(true), {
    class: 'primary',
  });
  const rest = button('Let the computer play', () => actions.steer(false));
  const hint = element('p', { class: 'hint' });
  return {
    node: element('div', { class: 'row' }, rejoin, ready, steer, rest, watch),
    /** How a mouse or a finger plays. */
    hint,
    show({ round, acting, mouse }: MatchBarState): void {
      const out = isOut(round);
      const seated = round !== null && round.seat !== null;
      isReady = round?.ready ?? false;
      rejoin.hidden = !out;
      ready.hidden = !seated || round.phase === 'running' || acting;
      ready.textContent = isReady ? 'Wait for me' : round?.phase === 'over' ? 'Play again' : 'Ready';
      ready.classList.toggle('primary', !isReady && !out);
      const text = round?.hints[touch ? 'touch' : 'mouse'] ?? null;
      steer.hidden = !seated || mouse !== false || text === null;
      steer.classList.toggle('primary', !out);
      rest.hidden = !seated || mouse !== true;
      watch.hidden = !seated;
      for (const each of [ready, steer, rest, watch]) each.disabled = out;
      hint.hidden = !seated || mouse !== true || out;
      hint.textContent = text;
    },
  };
}

/** The places that are free, and for a spectator the players to follow. */
function createSeats(actions: MatchBarActions) {
  const places = createOffers({ class: 'places', role: 'group', 'aria-label': 'Places' });
  const cameras = createOffers({ class: 'segments', role: 'group', 'aria-label': 'Camera' });
  const sit = ({ seat, role }: MatchRound['people'][number]): Offer => ({
    seat,
    label: `Play as ${role.toLowerCase()}`,
    act: () => actions.sit(seat),
  });
  const camera = (label: string, seat: number | null, following: number | null): Offer => ({
    seat,
    label,
    act: () => actions.follow(seat),
    pressed: seat === following,
  });
  return {
    places: places.node,
    cameras: cameras.node,
    show({ round, following }: MatchBarState): void {
      const free = round && round.phase !== 'running' ? round.people.filter((person) => person.free) : [];
      places.show(free.map(sit), isOut(round));
      const followed = round?.seat === null ? otherPlayers(round, false) : null;
      cameras.show(
        followed
          ? [camera('Free', null, following), ...followed.map(({ seat, label }) => camera(label, seat, following))]
          : [],
      );
    },
  };
}

/** The reason why there are no shared rooms; null: there are, or the state is unknown. */
const serverTexts: Readonly<Record<ServerState, string | null>> = {
  unknown: null,
  asked: null,
  here: null,
  none: 'This page’s host has no threepoint server, so there are no shared rooms.',
  silent: 'The server with the shared rooms does not answer. Try again later.',
};

/** Creates the controls for playing with other people, or the reason why there is no shared room. */
function createCompany(game: GameOnBar, actions: MatchBarActions) {
  const openRoom = button('Play with others', actions.openRoom);
  const invite = button('Invite others', actions.invite);
  const status = element('p', { class: 'hint', role: 'status' });
  const ask = button('Ask again', actions.askServer);
  const link = createRoomLink(game.name, { main: false });
  /** The room that the link leads to; null: none yet. */
  let linked: string | null = null;
  return {
    node: element(
      'div',
      { class: 'company' },
      status,
      link.node,
      element('div', { class: 'row' }, openRoom, invite, ask),
    ),
    show({ room, server, round }: MatchBarState): void {
      // In a room the banner describes the problem with its server.
      const alone = game.bots && server === 'none' ? ' You can play alone with bots.' : '';
      const text = room === null && serverTexts[server] !== null ? serverTexts[server] + alone : null;
      if (status.textContent !== (text ?? '')) status.textContent = text;
      status.hidden = text === null;
      openRoom.hidden = room !== null || text !== null;
      openRoom.disabled = server !== 'here';
      const waited = room !== null && isWaitedFor(round);
      link.node.hidden = !waited;
      if (waited && room !== linked) {
        linked = room;
        link.show(room);
      }
      invite.hidden = room === null;
      ask.hidden = text === null;
    },
  };
}

/** Score, places and settings of a match. */
export function createMatchBar(game: GameOnBar, actions: MatchBarActions, setSound: (on: boolean) => void) {
  const score = createScore();
  const where = element('p', { class: 'hint' });
  const waiting = element('p', { class: 'waiting', role: 'status' });
  const seats = createSeats(actions);
  const buttons = createButtons(actions);
  const company = createCompany(game, actions);
  const voices = createVoicesBar(actions.voices);
  const players = createPlayers(game, actions, setSound);
  const node = element(
    'div',
    { class: 'round' },
    score.node,
    where,
    waiting,
    buttons.node,
    buttons.hint,
    company.node,
    seats.places,
    seats.cameras,
    voices.node,
    players.node,
  );
  node.hidden = true;
  return {
    node,
    show(state: MatchBarState | null, soundOn: boolean): void {
      node.hidden = state === null;
      if (!state) return;
      const { round } = state;
      score.show(round);
      where.textContent = whereText(state);
      const sentence = round?.ended ?? round?.waiting ?? null;
      if (waiting.textContent !== (sentence ?? '')) waiting.textContent = sentence;
      waiting.hidden = sentence === null;
      buttons.show(state);
      seats.show(state);
      company.show(state);
      if (round) voices.show(round.voices, round);
      else voices.node.hidden = true;
      players.show(state, soundOn);
    },
  };
}
