// "threepoint-study/server": the service of studies and its thread.
export { loadStudyPlugins } from './plugins/load-plugins';
export { openStudyService } from './service';
export { serveStudies } from './thread';
