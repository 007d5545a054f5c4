import { button, element } from './element';

/** A match as the bar shows it. */
export interface BallRound {
  readonly phase: 'ready' | 'running' | 'over';
  readonly score: number;
  readonly of: number;
  readonly ballsLeft: number;
  readonly secondsLeft: number;
  /** The clock stands. */
  readonly paused: boolean;
  /** Oneself: rather than holding the basket, or watching. */
  readonly throws: boolean;
  readonly role: string;
  readonly seat: number | null;
  readonly ready: boolean;
  readonly rotate: boolean;
  readonly spectators: number;
  readonly people: readonly {
    readonly seat: number;
    readonly name: string;
    readonly role: string;
    readonly free: boolean;
  }[];
}

/** The ball game as the bar shows it. */
export interface BallBarState {
  /** null: not in the room yet. */
  readonly round: BallRound | null;
  /** null: in this page alone. */
  readonly room: string | null;
  readonly bots: boolean;
  /** A built-in player moves the own body: there is nobody to ask. */
  readonly acting: boolean;
  /** The mouse moves the own body; null: it cannot, somebody wears a headset or steers an emulated one. */
  readonly mouse: boolean | null;
  readonly name: string;
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
  /** The camera of a spectator: with somebody, or null: free. */
  follow(seat: number | null): void;
  /** The mouse moves the own body, or a built-in player does. */
  steer(on: boolean): void;
}

/** Score, places and settings of the ball game, beside the picture. */
export function createBallBar(actions: BallBarActions, setSound: (on: boolean) => void) {
  const score = element('output', { class: 'score', 'aria-label': 'Score' });
  const left = element('span', { class: 'arrows' });
  const time = element('span', { class: 'time' });
  const where = element('p', { class: 'hint' });
  const ready = button('Ready', () => actions.ready(!isReady), { class: 'primary' });
  const watch = button('Watch', () => actions.sit(null));
  const steer = button('Play with the mouse', () => actions.steer(true), { class: 'primary' });
  const rest = button('Let the built-in player play', () => actions.steer(false));
  const hint = element('p', { class: 'hint' });
  const places = element('div', { class: 'places', role: 'group', 'aria-label': 'Places' });
  const cameras = element('div', { class: 'segments', role: 'group', 'aria-label': 'Camera' });
  const check = (label: string, onChange: (on: boolean) => void) => {
    const input = element('input', { type: 'checkbox', role: 'switch' });
    input.addEventListener('change', () => onChange(input.checked));
    return { input, node: element('label', { class: 'toggle' }, element('span', {}, label), input) };
  };
  const bots = check('Bots take free places', actions.setBots);
  const rotate = check('Swap roles after each match', actions.rotate);
  const sound = check('Sound', setSound);
  const name = element('input', { type: 'text', maxlength: 24, autocomplete: 'nickname', 'aria-label': 'Your name' });
  name.addEventListener('change', () => actions.setName(name.value));
  const openRoom = button('Play with others', actions.openRoom);
  const link = element('a', { class: 'hint', target: '_blank', rel: 'noopener' }, 'Link for the others');
  const node = element(
    'div',
    { class: 'round' },
    element('div', { class: 'row board' }, score, left, time),
    where,
    places,
    cameras,
    element('div', { class: 'row' }, ready, steer, rest, watch),
    hint,
    element(
      'details',
      {},
      element('summary', {}, 'Players and rules'),
      element('label', { class: 'toggle' }, element('span', {}, 'Your name'), name),
      bots.node,
      rotate.node,
      sound.node,
      element('div', { class: 'row' }, openRoom),
      link,
    ),
  );
  node.hidden = true;
  let isReady = false;
  let placesShown = '';
  let camerasShown = '';

  return {
    node,
    show(state: BallBarState | null, soundOn: boolean): void {
      node.hidden = state === null;
      if (!state) return;
      const { round } = state;
      score.textContent = round ? `${round.score} / ${round.of}` : '–';
      left.textContent = round ? `${round.ballsLeft} ${round.ballsLeft === 1 ? 'ball' : 'balls'}` : '';
      const seconds = round ? `${Math.ceil(round.secondsLeft)} s` : '';
      time.textContent = round?.paused ? `${seconds}, paused` : seconds;
      const place = state.room ? `Room “${state.room}”` : 'Your own room';
      // Whoever watches knows that already.
      const watchers = round ? round.spectators - (round.seat === null ? 1 : 0) : 0;
      const watching = watchers > 0 ? ` · ${watchers} ${round?.seat === null ? 'more ' : ''}watching` : '';
      where.textContent = round ? `${place} · ${round.role}${watching}` : `${place} · joining …`;
      isReady = round?.ready ?? false;
      ready.hidden = !round || round.seat === null || round.phase === 'running' || state.acting;
      ready.textContent = isReady ? 'Wait for me' : round?.phase === 'over' ? 'Play again' : 'Ready';
      ready.classList.toggle('primary', !isReady);
      const seated = round !== null && round.seat !== null;
      steer.hidden = !seated || state.mouse !== false;
      rest.hidden = !seated || state.mouse !== true;
      hint.hidden = !seated || state.mouse !== true;
      hint.textContent = round?.throws
        ? 'Point at the basket and hold the button: the ring shows where the ball will come down. Let go when it is green. Esc: not yet.'
        : 'Point at where the basket is to be; it turns towards the balls by itself.';
      watch.hidden = !round || round.seat === null;
      const free = (round?.people ?? []).filter(({ free }) => free && round?.phase !== 'running');
      const key = JSON.stringify(free);
      if (key !== placesShown) {
        placesShown = key;
        places.replaceChildren(
          ...free.map(({ seat, role }) => button(`Play as ${role.toLowerCase()}`, () => actions.sit(seat))),
        );
      }
      places.hidden = free.length === 0;
      const followed = round?.seat === null ? round.people.filter(({ name }) => name !== 'free') : [];
      const cameraKey = JSON.stringify([followed, state.following]);
      if (cameraKey !== camerasShown) {
        camerasShown = cameraKey;
        const choice = (label: string, seat: number | null) =>
          button(label, () => actions.follow(seat), { 'aria-pressed': String(seat === state.following) });
        cameras.replaceChildren(choice('Free', null), ...followed.map(({ seat, name }) => choice(name, seat)));
      }
      cameras.hidden = round?.seat !== null || !round;
      bots.input.checked = state.bots;
      rotate.input.checked = round?.rotate ?? false;
      rotate.input.disabled = round?.seat === null;
      sound.input.checked = soundOn;
      if (document.activeElement !== name) name.value = state.name;
      openRoom.hidden = state.room !== null;
      link.hidden = state.room === null;
      if (state.room) link.href = `?play=ball&room=${encodeURIComponent(state.room)}`;
    },
  };
}
