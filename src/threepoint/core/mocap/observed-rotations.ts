import { angleBetween, copyQuat, normaliseQuat, type Quat, quat, setQuat } from '../math/quat';

/** The time between observations that count [s], and the smallest turn between them [rad]. */
const observedEvery = 0.25;
const observedTurn = 0.03;
/** The number of observations at which a mean is half sure. */
const halfSure = 10;
/** The angle [rad] beyond which a rotation counts less for the mean. */
const usualDeviation = 0.2;
/** The number of steps to a mean. */
const steps = 8;

/** Returns the rotation in the middle of rotations; far ones count less. There is at least one. */
export function meanRotation(rotations: readonly Quat[]): Quat {
  const mean = copyQuat(rotations[rotations.length >> 1]!);
  const sum = quat(0, 0, 0, 0);
  for (let step = 0; step < steps; step++) {
    setQuat(sum, 0, 0, 0, 0);
    for (const q of rotations) {
      const sign = q.x * mean.x + q.y * mean.y + q.z * mean.z + q.w * mean.w < 0 ? -1 : 1;
      const weight = sign / Math.max(usualDeviation, angleBetween(q, mean));
      setQuat(sum, sum.x + weight * q.x, sum.y + weight * q.y, sum.z + weight * q.z, sum.w + weight * q.w);
    }
    normaliseQuat(sum, mean);
  }
  return mean;
}

/** Returns how sure a mean rotation is, from 0 to 1, by how often and how far apart it was observed. */
export function surenessOf(mean: Quat, rotations: readonly Quat[], seconds: number): number {
  const every = Math.max(1, Math.ceil((observedEvery * rotations.length) / seconds));
  let [last, count, together]: [Quat, number, number] = [mean, 0, 0];
  for (let i = 0; i < rotations.length; i += every) {
    const rotation = rotations[i]!;
    if (count > 0 && angleBetween(rotation, last) < observedTurn) continue;
    [last, count, together] = [rotation, count + 1, together + Math.cos(angleBetween(rotation, mean))];
  }
  return (Math.max(0, together / count) * count) / (count + halfSure);
}
