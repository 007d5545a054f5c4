import type { SimulatedGame } from 'threepoint-games/all';
import { TrialLog, type TrialOutcome } from '../model/records/trial-log';
import type { RandomSource } from './random-source';

/**
 * The model of simulated play and of the frame rate of a simulated headset. The parameters are stated, not fitted to
 * people, and keep scores inside their scale.
 */
export interface PerformanceModel {
  /** The chance to hit each target of a game for one, the nearest first. */
  readonly hitChance: readonly number[];
  /** The chance that an attempt of a group scores. */
  readonly catchChance: number;
  /** The standard deviation of skill between persons (groups where several play), added to the chances. */
  readonly skillDeviation: number;
  /** The effect of a condition or a cohort on the chances, by its id. */
  readonly effects: Readonly<Record<string, number>>;
  /** The effect of the second and later blocks on the chances. */
  readonly practice: number;
  /** The time between two shots [s]: mean and standard deviation. */
  readonly pace: { readonly mean: number; readonly deviation: number };
  /** The median work per frame by estimator [ms]; the spread is the standard deviation of its logarithm. */
  readonly frameMs: Readonly<Record<string, number>>;
  readonly frameSpread: number;
  readonly refreshRateHz: number;
  /** The chance per trial that a hand is lost, and for how many seconds. */
  readonly loss: { readonly chance: number; readonly seconds: number };
  /** The chance per trial of a reload, and per block of being voided. */
  readonly mishaps: { readonly reload: number; readonly voided: number };
}

export const statedPerformanceModel: PerformanceModel = {
  hitChance: [0.9, 0.8, 0.65, 0.5],
  catchChance: 0.85,
  skillDeviation: 0.08,
  effects: {},
  practice: 0.02,
  pace: { mean: 7, deviation: 1.5 },
  frameMs: { 'hands-only': 4, ik: 5, paper: 6, 'paper-published': 6, learned: 5.5 },
  frameSpread: 0.25,
  refreshRateHz: 72,
  loss: { chance: 0.2, seconds: 0.5 },
  mishaps: { reload: 0.05, voided: 0.02 },
};

/** A game as its trials are simulated; `ends`: the first is that no attempt is left, the second that no target is. */
type Simulated<Kind> = Kind & { readonly ends: readonly string[] };

export interface Player {
  /** A value added to every chance. */
  readonly skill: number;
  readonly eyeHeight: number;
  readonly armSpan: number;
}

/** Draws a simulated participant's skill and measures. */
export function drawPlayer(model: PerformanceModel, random: RandomSource): Player {
  const eyeHeight = Math.min(1.9, Math.max(1.35, 1.58 + 0.09 * random.normal()));
  return { skill: model.skillDeviation * random.normal(), eyeHeight, armSpan: 0.945 * eyeHeight };
}

/** The terms of a trial that a result depends on. */
export interface Circumstances {
  readonly estimator: string;
  /** null: a tutorial. */
  readonly condition: string | null;
  /** null: the plan has none. */
  readonly cohort: string | null;
  readonly block: number;
  /** The time limit of the trial [s]. */
  readonly seconds: number;
}

const clampChance = (chance: number) => Math.min(0.98, Math.max(0.02, chance));

function chanceUnder({ effects, practice }: PerformanceModel, { condition, cohort, block }: Circumstances): number {
  const effectOf = (id: string | null) => (id === null ? 0 : (effects[id] ?? 0));
  return effectOf(condition) + effectOf(cohort) + (block > 1 ? practice : 0);
}

function logFor(model: PerformanceModel, player: Player) {
  const { refreshRateHz } = model;
  return new TrialLog(
    { name: 'Simulated headset', refreshRateHz, input: 'simulated' },
    { eyeHeight: player.eyeHeight, armSpan: player.armSpan },
  );
}

/** Adds frames and tracking for a number of seconds. */
function addFrames(
  log: TrialLog,
  model: PerformanceModel,
  { estimator }: Circumstances,
  seconds: number,
  random: RandomSource,
): void {
  const median = model.frameMs[estimator] ?? 5;
  const budgetMs = 1000 / model.refreshRateHz;
  const lossStart = random.uniform() < model.loss.chance ? random.uniform() * seconds : Number.POSITIVE_INFINITY;
  const frames = Math.floor(seconds * model.refreshRateHz);
  for (let index = 0; index < frames; index++) {
    const time = index / model.refreshRateHz;
    const frame = median * Math.exp(model.frameSpread * random.normal());
    log.frame({ frame }, frame > budgetMs);
    const lost = time >= lossStart && time < lossStart + model.loss.seconds;
    log.tracked(time, { head: true, leftHand: true, rightHand: !lost });
  }
}

const pause = (model: PerformanceModel, random: RandomSource, among = 1) =>
  Math.max(1, model.pace.mean + model.pace.deviation * random.normal()) / among;

/** Draws a round for one player, who aims at the last target that is not hit yet. */
export function drawTargets(
  { points: targetPoints, attempts, ends }: Simulated<Extract<SimulatedGame, { points: unknown }>>,
  model: PerformanceModel,
  player: Player,
  circumstances: Circumstances,
  random: RandomSource,
): TrialOutcome {
  const log = logFor(model, player);
  const open = new Set(targetPoints.keys());
  let time = 0;
  let score = 0;
  let [ended = 'time', cleared = 'time'] = ends as readonly TrialOutcome['ended'][];
  for (let attempt = 0; attempt < attempts; attempt++) {
    if (open.size === 0) {
      ended = cleared;
      break;
    }
    const next = time + pause(model, random);
    if (next > circumstances.seconds) {
      ended = 'time';
      time = circumstances.seconds;
      break;
    }
    time = next;
    const target = Math.max(...open);
    log.shot();
    const chance = clampChance((model.hitChance[target] ?? 0) + player.skill + chanceUnder(model, circumstances));
    const points = random.uniform() < chance ? (targetPoints[target] as number) : 0;
    if (points > 0) open.delete(target);
    score += points;
    log.event({ time, type: points > 0 ? 'hit' : 'miss', points });
  }
  addFrames(log, model, circumstances, time, random);
  const maximum = targetPoints.reduce((sum, points) => sum + points, 0);
  return log.finish({ seconds: time, ended, score, maximum, motionFrames: 0 });
}

/** Draws a round for a group, whose first members try in turn. */
export function drawShared(
  { attempts, triers, ends }: Simulated<Extract<SimulatedGame, { triers: unknown }>>,
  model: PerformanceModel,
  players: readonly Player[],
  circumstances: Circumstances,
  random: RandomSource,
): readonly TrialOutcome[] {
  const logs = players.map((player) => logFor(model, player));
  const skill = players.reduce((sum, player) => sum + player.skill, 0) / players.length;
  const chance = clampChance(model.catchChance + skill + chanceUnder(model, circumstances));
  let time = 0;
  let score = 0;
  let [ended = 'time'] = ends as readonly TrialOutcome['ended'][];
  for (let attempt = 0; attempt < attempts; attempt++) {
    const next = time + pause(model, random, triers);
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
    addFrames(log, model, circumstances, time, random);
    return log.finish({ seconds: time, ended, score, maximum: attempts, motionFrames: 0 });
  });
}
