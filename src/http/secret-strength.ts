/** The least length of a secret; a random one of 32 hexadecimal digits has 128 bits. */
const shortestSecret = 32;

/** Returns why a secret is too short, as a clause that follows its name in a sentence; null: it is long enough. */
export function secretWeakness({ length }: string): string | null {
  if (length >= shortestSecret) return null;
  return `has ${length} characters; it needs ${shortestSecret}. Generate one: openssl rand -base64 32`;
}
