/** The size [m] of the boundary's bounding box, along the axes of the floor. */
export interface BoundarySize {
  readonly width: number;
  readonly depth: number;
}

/** Returns the size of the session's boundary; null: the device has none, or does not report it. */
export async function readBoundary(session: XRSession): Promise<BoundarySize | null> {
  let space: XRReferenceSpace;
  try {
    space = await session.requestReferenceSpace('bounded-floor');
  } catch {
    // reason: a device without a boundary is a usual one; null says so
    return null;
  }
  const { boundsGeometry = [] } = space as Partial<XRBoundedReferenceSpace>;
  if (boundsGeometry.length < 3) return null;
  const [xs, zs] = [boundsGeometry.map(({ x }) => x), boundsGeometry.map(({ z }) => z)];
  return { width: Math.max(...xs) - Math.min(...xs), depth: Math.max(...zs) - Math.min(...zs) };
}
