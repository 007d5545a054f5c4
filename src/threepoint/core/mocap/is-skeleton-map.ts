/**
 * Whether the text of a JSON file may be meant as a map of a skeleton (read-skeleton-map.ts), which a recording is not.
 */
export function isSkeletonMap(text: string): boolean {
  try {
    const content: unknown = JSON.parse(text);
    if (typeof content !== 'object' || content === null || !('joints' in content)) return false;
    return typeof content.joints === 'object' && !('format' in content);
  } catch {
    // reason: what is no JSON is no map; who reads it as something else says what is wrong with it.
    return false;
  }
}
