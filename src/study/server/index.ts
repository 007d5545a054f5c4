// "threepoint-study/server": the service of studies and its thread.
export { openStudyService } from './service';
export { serveStudies } from './thread';
