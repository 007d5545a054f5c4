/** A size that a document says may be so far from what was measured, as a share of it; a small one may be rounded further. */
const tolerance = 0.03;

const kilobytes = (bytes, digits) => `${(bytes / 1000).toFixed(digits)} kB`;
const digitsOf = (kB) => kB.split('.')[1]?.length ?? 0;
const isTrue = (kB, bytes) =>
  Math.abs(1000 * kB - bytes) <= tolerance * bytes || kilobytes(bytes, digitsOf(kB)) === `${kB} kB`;

/**
 * Sentences for the sizes in the text of a document, the file of this name, that are no longer true. claims: `what` weighs so many `bytes`, the
 * pattern `says` finds their kilobytes in the text.
 */
export function staleSizes(file, text, claims) {
  return claims.flatMap(({ what, says, bytes }) => {
    const said = says.exec(text)?.slice(1);
    if (!said) return [`${file} does not say what ${what} weighs`];
    if (said.every((kB, i) => isTrue(kB, bytes[i]))) return [];
    const digits = digitsOf(said[0]);
    const told = (sizes) => sizes.join(' and ');
    const is = told(bytes.map((size) => kilobytes(size, digits)));
    return [`${file} says ${told(said.map((kB) => `${kB} kB`))} of ${what}, it is ${is}`];
  });
}
