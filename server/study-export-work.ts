import { parentPort, workerData } from 'node:worker_threads';
import { exportZip } from './study-export';
import type { Exported } from './study-export-thread';
import { unpacked } from './study-motion';

// The work of one thread: an export from what is stored, sent back as the bytes of its zip.
const { content, participant } = workerData as Exported;
const zip = exportZip({ ...content, motion: content.motion.map(unpacked) }, participant);
parentPort?.postMessage(zip, [zip.buffer as ArrayBuffer]);
