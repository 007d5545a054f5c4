import type { HttpResponse } from 'threepoint-http/response';
import { exportName } from '../export/export-zip';
import type { RouteAccess } from './guard';
import { type Handle, route, type StudyParts, type StudyRoute } from './route';

interface ExportAsked {
  readonly at: number;
  readonly study: string;
  readonly participant?: string;
  readonly version?: number | undefined;
}

/** Resolves with the answer that contains an export. */
export async function exportOf({ store, software, makeZip }: StudyParts, asked: ExportAsked): Promise<HttpResponse> {
  const { participant } = asked;
  const info = store.plans.get(asked.study, asked.version);
  const plan = participant === undefined ? info.plan : store.plans.planFor(asked.study, participant);
  if (participant !== undefined) store.places.get(asked.study, participant);
  const planVersion = participant === undefined && info.versions.length > 1 ? info.version : undefined;
  const name = exportName({ plan, simulated: info.simulated, ...(planVersion && { planVersion }) }, participant);
  return {
    status: 200,
    headers: { 'content-type': 'application/zip', 'content-disposition': `attachment; filename="${name}.zip"` },
    body: await makeZip({ ...asked, version: info.version, software }),
  };
}

/** Returns a route whose answer is an export. */
export const exporting = (path: string, access: RouteAccess, handle: Handle): StudyRoute => ({
  ...route('GET', path, access, 0, handle),
  isPatient: true,
});
