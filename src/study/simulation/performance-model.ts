import { createTrialLog, type TrialOutcome } from '../model/records/trial-log';
import type { RandomSource } from './random-source';

/**
 * How well simulated participants play, and how smoothly a simulated headset runs. Stated, not fitted: the numbers are chosen so
 * that scores lie inside the scale, and no person's play is imitated.
 */
export interface PerformanceModel {
  /** Chance to hit each archery target with an arrow aimed at it, nearest first. */
  readonly hitChance: readonly number[];
  /** Chance that a thrown ball is caught. */
  readonly catchChance: number;
  /** Standard deviation of skill between persons (groups, in the ball game), added to the chances. */
  readonly skillDeviation: number;
  /** Added to the chances under a condition, or in a cohort, by its id. */
  readonly effects: Readonly<Record<string, number>>;
  /** Added to the chances in the second and later blocks. */
  readonly practice: number;
  /** Seconds between two shots: mean and standard deviation. */
  readonly pace: { readonly mean: number; readonly deviation: number };
  /** Work per frame [ms], by estimator: median; spread is the deviation of its logarithm. */
  readonly frameMs: Readonly<Record<string, number>>;
  readonly frameSpread: number;
  readonly refreshRateHz: number;
  /** Chance per trial that a hand is lost, and for how many seconds. */
  readonly loss: { readonly chance: number; readonly seconds: number };
  /** Chance per trial that the page is loaded again in the middle, and per block that the experimenter voids it. */
  readonly mishaps: { readonly reload: number; readonly voided: number };
}

export const statedPerformanceModel: PerformanceModel = {
  hitChance: [0.9, 0.8, 0.65, 0.5],
  catchChance: 0.85,
  skillDeviation: 0.08,
  effects: {},
  practice: 0.02,
  pace: { mean: 7, deviation: 1.5 },
  frameMs: { 'hands-only': 4, ik: 5, paper: 6, learned: 5.5 },
  frameSpread: 0.25,
  refreshRateHz: 72,
  loss: { chance: 0.2, seconds: 0.5 },
  mishaps: { reload: 0.05, voided: 0.02 },
};

/** The targets of the archery game: each scores once. */
const targetPoints = [5, 10, 15, 20];
const archeryArrows = 5;
const balls = 20;

export interface Player {
  /** Added to every chance. */
  readonly skill: number;
  readonly eyeHeight: number;
  readonly armSpan: number;
}

/** A simulated participant's skill and measures. */
export function drawPlayer(model: PerformanceModel, random: RandomSource): Player {
  const eyeHeight = Math.min(1.9, Math.max(1.35, 1.58 + 0.09 * random.normal()));
  return { skill: model.skillDeviation * random.normal(), eyeHeight, armSpan: 0.945 * eyeHeight };
}

interface Circumstances {
  readonly estimator: string;
  /** null: a tutorial. */
  readonly condition: string | null;
  /** null: the plan has none. */
  readonly cohort: string | null;
  readonly block: number;
  /** Time limit of the trial. */
  readonly seconds: number;
}

const clampChance = (chance: number) => Math.min(0.98, Math.max(0.02, chance));

function chanceUnder({ effects, practice }: PerformanceModel, { condition, cohort, block }: Circumstances): number {
  const effectOf = (id: string | null) => (id === null ? 0 : (effects[id] ?? 0));
  return effectOf(condition) + effectOf(cohort) + (block > 1 ? practice : 0);
}

function logFor(model: PerformanceModel, player: Player) {
  const { refreshRateHz } = model;
  return createTrialLog(
    { name: 'Simulated headset', refreshRateHz, input: 'simulated' },
    { eyeHeight: player.eyeHeight, armSpan: player.armSpan },
  );
}

/** Frames and tracking of so many seconds. */
function addFrames(
  log: ReturnType<typeof logFor>,
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

/** One round of archery: at the farthest target not yet hit, as the points ask for. */
export function drawArchery(
  model: PerformanceModel,
  player: Player,
  circumstances: Circumstances,
  random: RandomSource,
): TrialOutcome {
  const log = logFor(model, player);
  const open = new Set(targetPoints.keys());
  let time = 0;
  let score = 0;
  let ended: TrialOutcome['ended'] = 'arrows';
  for (let arrow = 0; arrow < archeryArrows; arrow++) {
    if (open.size === 0) {
      ended = 'targets';
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

/** One round of the ball game for a whole group: the last member holds the basket, the others throw in turn. */
export function drawBall(
  model: PerformanceModel,
  players: readonly Player[],
  circumstances: Circumstances,
  random: RandomSource,
): readonly TrialOutcome[] {
  const logs = players.map((player) => logFor(model, player));
  const throwers = Math.max(1, players.length - 1);
  const skill = players.reduce((sum, player) => sum + player.skill, 0) / players.length;
  const chance = clampChance(model.catchChance + skill + chanceUnder(model, circumstances));
  let time = 0;
  let score = 0;
  let ended: TrialOutcome['ended'] = 'balls';
  for (let ball = 0; ball < balls; ball++) {
    const next = time + pause(model, random, throwers);
    if (next > circumstances.seconds) {
      ended = 'time';
      time = circumstances.seconds;
      break;
    }
    time = next;
    const thrower = logs[ball % throwers] as (typeof logs)[number];
    thrower.shot();
    const caught = random.uniform() < chance;
    thrower.event({ time, type: caught ? 'hit' : 'miss', points: Number(caught) });
    if (caught) {
      score += 1;
      if (logs.length > throwers) logs.at(-1)?.event({ time, type: 'catch', points: 0 });
    }
  }
  return logs.map((log) => {
    addFrames(log, model, circumstances, time, random);
    return log.finish({ seconds: time, ended, score, maximum: balls, motionFrames: 0 });
  });
}
