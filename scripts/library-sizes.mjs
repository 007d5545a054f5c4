/** The relative tolerance between a stated and a measured size; small sizes have a larger one, for rounding. */
const tolerance = 0.03;

const kilobytes = (bytes, digits) => `${(bytes / 1000).toFixed(digits)} kB`;
const digitsOf = (kB) => kB.split('.')[1]?.length ?? 0;
const isTrue = (kB, bytes) =>
  Math.abs(1000 * kB - bytes) <= tolerance * bytes || kilobytes(bytes, digitsOf(kB)) === `${kB} kB`;

/**
 * Returns a message for each size in a document that is no longer true. A claim states that `what` has this many
 * `bytes`; its pattern `says` finds the kilobytes in the text.
 */
export function staleSizes(file, text, claims) {
  return claims.flatMap(({ what, says, bytes }) => {
    const said = says.exec(text)?.slice(1);
    if (!said) return [`${file} does not say what ${what} weighs`];
    if (said.every((kB, i) => isTrue(kB, bytes[i]))) return [];
    const digits = digitsOf(said[0]);
    const is = bytes.map((size) => kilobytes(size, digits)).join(' and ');
    return [`${file} says ${said.map((kB) => `${kB} kB`).join(' and ')} of ${what}, it is ${is}`];
  });
}
