import { type HeapProfiler, Session } from 'node:inspector';

/** Frames before the measurement: what runs in every frame is compiled by then. */
const warmUpFrames = 5_000;
const measuredFrames = 2_000;

/** Returns the bytes that functions under src/ allocate, with all that they call. */
function sourceBytes(node: HeapProfiler.SamplingHeapProfileNode, calledBySource = false): number {
  const counts = calledBySource || node.callFrame.url.includes('/src/');
  return node.children.reduce((sum, child) => sum + sourceBytes(child, counts), counts ? node.selfSize : 0);
}

/** Returns the bytes that a frame allocates in functions under src/ and what they call, collected or not. */
export function allocatedPerFrame(frame: () => void): number {
  const session = new Session();
  session.connect();
  for (let i = 0; i < warmUpFrames; i++) frame();
  session.post('HeapProfiler.startSampling', {
    samplingInterval: 64,
    includeObjectsCollectedByMajorGC: true,
    includeObjectsCollectedByMinorGC: true,
  });
  for (let i = 0; i < measuredFrames; i++) frame();
  let bytes = 0;
  session.post('HeapProfiler.stopSampling', (error, { profile }) => {
    if (error) throw error;
    bytes = sourceBytes(profile.head);
  });
  session.disconnect();
  return bytes / measuredFrames;
}
