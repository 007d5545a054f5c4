import type { ServerState } from 'threepoint-http/server-presence';
import { button, element } from 'threepoint-ui/element';
import { createRoomLink } from 'threepoint-ui/invitation';
import { ballRulesText, rulesList } from 'threepoint-ui/rules';
import { toggle } from 'threepoint-ui/toggle';
import { otherPlayers, type Seated } from './other-players';
import { createVoicesBar, type VoicesBarActions } from './voices-bar';
import type { VoicesState } from './voices-state';

/** A match as the bar shows it. */
export interface BallRound {
  readonly phase: 'ready' | 'running' | 'over';
  readonly score: number;
  readonly of: number;
  readonly ballsLeft: number;
  /** Until the bell; of a match that is over, what was left at its end. */
  readonly secondsLeft: number;
  /** How long a match is. */
  readonly seconds: number;
  /** The clock stands. */
  readonly paused: boolean;
  /** What the match waits for, in a sentence; null: for nothing. */
  readonly waiting: string | null;
  /** How good the connection is, in words; null: there is none, the room is in this page. */
  readonly connection: string | null;
  /** Why this page is in the room no longer; null: it is. */
  readonly ended: string | null;
  /** Oneself: rather than holding the basket, or watching. */
  readonly throws: boolean;
  readonly role: string;
  readonly seat: number | null;
  readonly ready: boolean;
  readonly rotate: boolean;
  readonly spectators: number;
  /** All seats; `free`: can be taken by a person. */
  readonly people: readonly (Seated & { readonly free: boolean })[];
  readonly voices: VoicesState;
}

/** The ball game as the bar shows it. */
export interface BallBarState {
  /** null: not in the room yet. */
  readonly round: BallRound | null;
  /** null: in this page alone. */
  readonly room: string | null;
  /** Who could host a room for others. */
  readonly server: ServerState;
  readonly bots: boolean;
  /** A built-in player moves the own body: no person is there to be asked. */
  readonly acting: boolean;
  /** The mouse moves the own body; null: it cannot, a headset is worn or an emulated one is steered. */
  readonly mouse: boolean | null;
  readonly name: string;
  /** What others call a player who has given no name. */
  readonly guestName: string;
  /** Of a spectator: free, or the seat that is followed. */
  readonly following: number | null;
}

export interface BallBarActions {
  ready(on: boolean): void;
  rotate(on: boolean): void;
  sit(seat: number | null): void;
  setBots(on: boolean): void;
  setName(name: string): void;
  /** Opens a room where others can come too. */
  openRoom(): void;
  /** Looks for the server once more. */
  askServer(): void;
  /** Shows what to send to others so that they come. */
  invite(): void;
  /** Into the room again that this page is in no longer. */
  rejoin(): void;
  /** The camera of a spectator: with a player, or null: free. */
  follow(seat: number | null): void;
  /** The mouse moves the own body, or a built-in player does. */
  steer(on: boolean): void;
  readonly voices: VoicesBarActions;
}

/** This page is in the room no longer. */
const isOut = (round: BallRound | null): boolean => (round?.ended ?? null) !== null;

/** Before and after a match, while another person could take a place. */
const isWaitedFor = (round: BallRound | null): boolean =>
  round !== null && !isOut(round) && round.phase !== 'running' && round.people.some(({ free }) => free);

/** A button for a seat; null: for none. */
interface Offer {
  readonly seat: number | null;
  readonly label: string;
  readonly act: () => void;
  readonly pressed?: boolean;
}

/** A row of buttons that is made anew when what it offers changes. */
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

/** Who plays and by which rules, folded away. */
function createPlayers(actions: BallBarActions, setSound: (on: boolean) => void) {
  const bots = toggle('Bots take free places', actions.setBots);
  const rotate = toggle('Swap roles after each match', actions.rotate);
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
    rotate.node,
    sound.node,
  );
  return {
    node,
    show({ round, bots: botsOn, name: given, guestName }: BallBarState, soundOn: boolean) {
      const sentences = ballRulesText(round?.of ?? 20, round?.seconds ?? 90);
      if (sentences.join() !== rulesShown) {
        rulesShown = sentences.join();
        rules.replaceChildren(rulesList(sentences));
      }
      bots.input.checked = botsOn;
      rotate.input.checked = round?.rotate ?? false;
      rotate.input.disabled = round?.seat === null || isOut(round);
      sound.input.checked = soundOn;
      name.placeholder = guestName;
      if (document.activeElement !== name) name.value = given;
    },
  };
}

/** Where this page plays, as what, and how good the connection is. */
function whereText({ round, room }: BallBarState): string {
  const place = room ? `Room “${room}”` : 'Your own room';
  if (!round) return `${place} · joining …`;
  // A spectator counts among the spectators, and knows that already.
  const watchers = round.spectators - (round.seat === null ? 1 : 0);
  const watching = watchers > 0 ? `${watchers} ${round.seat === null ? 'more ' : ''}watching` : null;
  return [place, round.role, watching, round.connection].filter(Boolean).join(' · ');
}

/** Balls in the basket, balls left, and the time. */
function createScore() {
  const score = element('output', { class: 'score', 'aria-label': 'Score' });
  const left = element('span', { class: 'arrows' });
  const time = element('span', { class: 'time' });
  return {
    node: element('div', { class: 'row board' }, score, left, time),
    show(round: BallRound | null): void {
      score.textContent = round ? `${round.score} / ${round.of}` : '–';
      left.textContent = round ? `${round.ballsLeft} ${round.ballsLeft === 1 ? 'ball' : 'balls'}` : '';
      const seconds = round ? `${Math.ceil(round.secondsLeft)} s` : '';
      time.textContent = round?.paused ? `${seconds}, paused` : seconds;
    },
  };
}

/** What can be pressed now; where this page is in the room no longer, nothing but the way back. */
function createActions(actions: BallBarActions) {
  let isReady = false;
  const ready = button('Ready', () => actions.ready(!isReady), { class: 'primary' });
  const rejoin = button('Take over again', actions.rejoin, { class: 'primary' });
  const watch = button('Watch', () => actions.sit(null));
  const steer = button('Play with the mouse', () => actions.steer(true), { class: 'primary' });
  const rest = button('Let the built-in player play', () => actions.steer(false));
  const hint = element('p', { class: 'hint' });
  return {
    node: element('div', { class: 'row' }, rejoin, ready, steer, rest, watch),
    /** How a mouse plays. */
    hint,
    show({ round, acting, mouse }: BallBarState): void {
      const out = isOut(round);
      const seated = round !== null && round.seat !== null;
      isReady = round?.ready ?? false;
      rejoin.hidden = !out;
      ready.hidden = !seated || round.phase === 'running' || acting;
      ready.textContent = isReady ? 'Wait for me' : round?.phase === 'over' ? 'Play again' : 'Ready';
      ready.classList.toggle('primary', !isReady && !out);
      steer.hidden = !seated || mouse !== false;
      steer.classList.toggle('primary', !out);
      rest.hidden = !seated || mouse !== true;
      watch.hidden = !seated;
      for (const button of [ready, steer, rest, watch]) button.disabled = out;
      hint.hidden = !seated || mouse !== true || out;
      hint.textContent = round?.throws
        ? 'Point at the basket and hold the button: the ring shows where the ball will come down. Let go when it is green. Esc: not yet.'
        : 'Point at where the basket is to be; it turns towards the balls by itself.';
    },
  };
}

/** The places that are free, and for a spectator the players to follow. */
function createSeats(actions: BallBarActions) {
  const places = createOffers({ class: 'places', role: 'group', 'aria-label': 'Places' });
  const cameras = createOffers({ class: 'segments', role: 'group', 'aria-label': 'Camera' });
  const sit = ({ seat, role }: BallRound['people'][number]): Offer => ({
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
    show({ round, following }: BallBarState): void {
      const free = round && round.phase !== 'running' ? round.people.filter((person) => person.free) : [];
      places.show(free.map(sit), isOut(round));
      const followed = round?.seat === null ? otherPlayers(round, false) : null;
      cameras.show(
        followed
          ? [camera('Free', null, following), ...followed.map(({ seat, name }) => camera(name, seat, following))]
          : [],
      );
    },
  };
}

/** Why there are no rooms for others; null: there are, or nothing is known yet. */
const serverTexts: Readonly<Record<ServerState, string | null>> = {
  unknown: null,
  asked: null,
  here: null,
  none: 'This page comes from a host without a threepoint server: there are no rooms for others. Alone, with bots, you can play.',
  silent: 'Rooms for others are on the server, which does not answer now.',
};

/** The way to others: a room for them, or why there is none. */
function createCompany(actions: BallBarActions) {
  const openRoom = button('Play with others', actions.openRoom);
  const invite = button('Invite others', actions.invite);
  const said = element('p', { class: 'hint', role: 'status' });
  const ask = button('Ask again', actions.askServer);
  const link = createRoomLink({ main: false });
  /** The room that the link leads to; null: none yet. */
  let linked: string | null = null;
  return {
    node: element(
      'div',
      { class: 'company' },
      said,
      link.node,
      element('div', { class: 'row' }, openRoom, invite, ask),
    ),
    show({ room, server, round }: BallBarState): void {
      // In a room the banner says what is the matter with its server.
      const text = room === null ? serverTexts[server] : null;
      if (said.textContent !== (text ?? '')) said.textContent = text;
      said.hidden = text === null;
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

/** Score, places and settings of the ball game, beside the picture. */
export function createBallBar(actions: BallBarActions, setSound: (on: boolean) => void) {
  const score = createScore();
  const where = element('p', { class: 'hint' });
  const waiting = element('p', { class: 'waiting', role: 'status' });
  const seats = createSeats(actions);
  const buttons = createActions(actions);
  const company = createCompany(actions);
  const voices = createVoicesBar(actions.voices);
  const players = createPlayers(actions, setSound);
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
    show(state: BallBarState | null, soundOn: boolean): void {
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
