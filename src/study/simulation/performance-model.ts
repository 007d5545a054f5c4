import type { SimulatedGame } from 'threepoint-games/all';
import { TrialLog, type TrialOutcome } from '../model/records/trial-log';
import type { RandomSource } from './random-source';

// The parameters of simulated play and of the frame rate of a simulated headset are stated, not fitted to people, and
// keep scores inside their scale.

/** The chance to hit each target of a game for one, the nearest first. */
const hitChance: readonly number[] = [0.9, 0.8, 0.65, 0.5];
/** The chance that an attempt of a group scores. */
const catchChance = 0.85;
/** The standard deviation of skill between persons (groups where several play), added to the chances. */
const skillDeviation = 0.08;
/** The time between two shots [s]: mean and standard deviation. */
const pace = { mean: 7, deviation: 1.5 };
/** The median work per frame by estimator [ms]; the spread is the standard deviation of its logarithm. */
const frameMs: Readonly<Record<string, number>> = {
  'hands-only': 4,
  ik: 5,
  paper: 6,
  'paper-published': 6,
  learned: 5.5,
};
const frameSpread = 0.25;
const refreshRateHz = 72;
/** The chance per trial that a hand is lost, and for how many seconds. */
const loss = { chance: 0.2, seconds: 0.5 };

/** A game as its trials are simulated; `ends`: the first is that no attempt is left, the second that no target is. */
type Simulated<Kind> = Kind & { readonly ends: readonly string[] };

export interface Player {
  /** A value added to every chance. */
  readonly skill: number;
  readonly eyeHeight: number;
  readonly armSpan: number;
}

export function drawPlayer(random: RandomSource): Player {
  const eyeHeight = Math.min(1.9, Math.max(1.35, 1.58 + 0.09 * random.normal()));
  return { skill: skillDeviation * random.normal(), eyeHeight, armSpan: 0.945 * eyeHeight };
}

/** The terms of a trial that a result depends on. */
export interface Circumstances {
  readonly estimator: string;
  /** The sum of the effects on the chances. */
  readonly effect: number;
  /** The time limit of the trial [s]. */
  readonly seconds: number;
}

const clampChance = (chance: number) => Math.min(0.98, Math.max(0.02, chance));

const logFor = ({ eyeHeight, armSpan }: Player): TrialLog =>
  new TrialLog({ name: 'Simulated headset', refreshRateHz, input: 'simulated' }, { eyeHeight, armSpan });

/** Adds frames and tracking for a number of seconds. */
function addFrames(log: TrialLog, { estimator }: Circumstances, seconds: number, random: RandomSource): void {
  const median = frameMs[estimator] ?? 5;
  const budgetMs = 1000 / refreshRateHz;
  const lossStart = random.uniform() < loss.chance ? random.uniform() * seconds : Number.POSITIVE_INFINITY;
  const frames = Math.floor(seconds * refreshRateHz);
  for (let index = 0; index < frames; index++) {
    const time = index / refreshRateHz;
    const frame = median * Math.exp(frameSpread * random.normal());
    log.frame({ frame }, frame > budgetMs);
    const lost = time >= lossStart && time < lossStart + loss.seconds;
    log.tracked(time, { head: true, leftHand: true, rightHand: !lost });
  }
}

const pause = (random: RandomSource, among = 1) => Math.max(1, pace.mean + pace.deviation * random.normal()) / among;

/** Draws a round for one player, who aims at the last target that is not hit yet. */
export function drawTargets(
  { points: targetPoints, attempts, ends }: Simulated<Extract<SimulatedGame, { points: unknown }>>,
  player: Player,
  circumstances: Circumstances,
  random: RandomSource,
): TrialOutcome {
  const log = logFor(player);
  const open = new Set(targetPoints.keys());
  let time = 0;
  let score = 0;
  let [ended = 'time', cleared = 'time'] = ends as readonly TrialOutcome['ended'][];
  for (let attempt = 0; attempt < attempts; attempt++) {
    if (open.size === 0) {
      ended = cleared;
      break;
    }
    const next = time + pause(random);
    if (next > circumstances.seconds) {
      ended = 'time';
      time = circumstances.seconds;
      break;
    }
    time = next;
    const target = Math.max(...open);
    log.shot();
    const chance = clampChance((hitChance[target] ?? 0) + player.skill + circumstances.effect);
    const points = random.uniform() < chance ? (targetPoints[target] as number) : 0;
    if (points > 0) open.delete(target);
    score += points;
    log.event({ time, type: points > 0 ? 'hit' : 'miss', points });
  }
  addFrames(log, circumstances, time, random);
  const maximum = targetPoints.reduce((sum, points) => sum + points, 0);
  return log.finish({ seconds: time, ended, score, maximum, motionFrames: 0 });
}

/** Draws a round for a group, whose first members try in turn. */
export function drawShared(
  { attempts, triers, ends }: Simulated<Extract<SimulatedGame, { triers: unknown }>>,
  players: readonly Player[],
  circumstances: Circumstances,
  random: RandomSource,
): readonly TrialOutcome[] {
  const logs = players.map((player) => logFor(player));
  const skill = players.reduce((sum, player) => sum + player.skill, 0) / players.length;
  const chance = clampChance(catchChance + skill + circumstances.effect);
  let time = 0;
  let score = 0;
  let [ended = 'time'] = ends as readonly TrialOutcome['ended'][];
  for (let attempt = 0; attempt < attempts; attempt++) {
    const next = time + pause(random, triers);
    if (next > circumstances.seconds) {
      ended = 'time';
      time = circumstances.seconds;
      break;
    }
    time = next;
    const thrower = logs[attempt % triers] as (typeof logs)[number];
    thrower.shot();
    const caught = random.uniform() < chance;
    thrower.event({ time, type: caught ? 'hit' : 'miss', points: Number(caught) });
    if (caught) {
      score += 1;
      for (const other of logs.slice(triers)) other.event({ time, type: 'catch', points: 0 });
    }
  }
  return logs.map((log) => {
    addFrames(log, circumstances, time, random);
    return log.finish({ seconds: time, ended, score, maximum: attempts, motionFrames: 0 });
  });
}
