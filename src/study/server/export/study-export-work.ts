import { openStudyStore } from '../sqlite/study-store';
import { unpacked } from '../study-storage';
import { exportZip } from './export-zip';
import type { ExportOrder } from './exporter';

// A process that reads the content of an export from the storage and writes it to its output as a zip file. Its
// arguments are the database and the order.

const [file, order] = process.argv.slice(-2) as [string, string];
const { at, study, version, participant, software } = JSON.parse(order) as ExportOrder;
const store = openStudyStore(file, { readOnly: true });
const { motion, served, ...stored } = store.storedStudy(study, version, participant);
store.close();
const content = { ...stored, motion: motion.map(unpacked), at, software: { exportedBy: software, served } };
process.stdout.write(exportZip(content, participant));
