import type { BallAction, BallEvent, BallLocation, BallState } from './ball-state';
import { withBall, withPlayer } from './state-changes';
import { ballInHand, tickSeconds } from './state-selectors';

const throwerOf = (location: BallLocation | undefined): number =>
  location?.on === 'air' || location?.on === 'floor' ? location.thrower : 0;

/**
 * Returns the state after an event of the Room: balls, score, phase, `rotate` and presence. The tick, heads, hands and
 * the basket do not follow from events; a page has the clock and poses for them. An event that arrives twice changes
 * nothing.
 */
export function applyBallEvent(state: BallState, event: BallEvent): BallState {
  switch (event.type) {
    case 'joined':
      return withPlayer(state, event.player, { present: true, ready: false });
    case 'left':
      return withPlayer(state, event.player, { present: false, ready: false });
    case 'ready':
      return withPlayer(state, event.player, { ready: event.ready });
    case 'rotate':
      return { ...state, rotate: event.rotate };
    case 'started':
      return { ...state, phase: 'running', startedAt: event.at };
    case 'grabbed':
      return withBall(state, event.ball, { on: 'hand', player: event.player, side: event.side });
    case 'returned':
      return withBall(state, event.ball, { on: 'rack' });
    case 'thrown':
      return withBall(state, event.ball, { on: 'air', launch: event.launch, thrower: event.player, missed: false });
    case 'bounced': {
      const before = state.balls[event.ball];
      const missed = event.off === 'floor' || (before?.on === 'air' && before.missed);
      return withBall(state, event.ball, { on: 'air', launch: event.launch, thrower: throwerOf(before), missed });
    }
    case 'missed': {
      const before = state.balls[event.ball];
      return before?.on === 'air' ? withBall(state, event.ball, { ...before, missed: true }) : state;
    }
    case 'rolls':
      return withBall(state, event.ball, {
        on: 'floor',
        launch: event.launch,
        thrower: throwerOf(state.balls[event.ball]),
      });
    case 'caught':
      return { ...withBall(state, event.ball, { on: 'basket', thrower: event.player }), score: event.score };
    case 'refused':
      return state;
    case 'ended':
      return {
        ...state,
        phase: 'over',
        end: event.end,
        score: event.score,
        players: state.players.map((player) => ({ ...player, ready: false })),
      };
  }
}

/** Returns the predicted state after the player's own action, if the rules allow it. */
export function predictBallAction(state: BallState, player: number, action: BallAction): BallState {
  if (action.type === 'rotate') return { ...state, rotate: action.rotate };
  if (state.phase !== 'running') return state;
  const inHand = ballInHand(state, player, action.side);
  switch (action.type) {
    case 'grab':
      return inHand < 0 && state.balls[action.ball]?.on === 'rack'
        ? withBall(state, action.ball, { on: 'hand', player, side: action.side })
        : state;
    case 'drop':
      return inHand >= 0 ? withBall(state, inHand, { on: 'rack' }) : state;
    case 'throw': {
      if (inHand !== action.ball) return state;
      const { at: time, position, velocity } = action;
      return withBall(state, inHand, {
        on: 'air',
        launch: { time, position, velocity },
        thrower: player,
        missed: false,
      });
    }
  }
}

/** Returns whether an event is the Room's answer to an action of the player. */
export function answersBallAction(event: BallEvent, player: number, action: BallAction): boolean {
  switch (event.type) {
    case 'refused':
      return event.player === player && event.sequence === action.sequence;
    case 'grabbed':
      return (
        action.type === 'grab' && event.player === player && event.ball === action.ball && event.side === action.side
      );
    case 'rotate':
      return action.type === 'rotate' && event.player === player && event.rotate === action.rotate;
    case 'thrown':
      return action.type === 'throw' && event.player === player && event.ball === action.ball;
    case 'returned':
      // A throw that is too slow returns the ball.
      return (
        event.player === player && (action.type === 'drop' || (action.type === 'throw' && action.ball === event.ball))
      );
    default:
      return false;
  }
}

/** Returns the state with the tick of this match time [s]. */
export const withMatchTime = (state: BallState, time: number): BallState => ({
  ...state,
  tick: Math.max(0, Math.floor(time / tickSeconds)),
});
