import { isObject } from '../json';

/**
 * Returns whether the text of a JSON file may be meant as a map of a skeleton (read-skeleton-map.ts), which a recording
 * is not.
 */
export function isSkeletonMap(text: string): boolean {
  try {
    const content: unknown = JSON.parse(text);
    return isObject(content) && typeof content.joints === 'object' && !('format' in content);
  } catch {
    // reason: text that is not JSON is not a map; its own reader reports the fault.
    return false;
  }
}
