// "threepoint-http": the parts of an HTTP server that rooms and studies share.
export { AdminGuard } from './admin-guard';
export { type AuthAttempt, createAuthThrottle, type FailedAttempt } from './auth-throttle';
export { type ClientAddress, clientAddressOf, findClientAddress, requiredAddress } from './client-address';
export { ConfigurationError } from './configuration-error';
export { ConnectionLimiter, createSlotCounter } from './connection-limiter';
export { invalidVariable, numberFrom, splitList } from './environment';
export { GroupCommit } from './group-commit';
export { guarded } from './guarded';
export { errorLine, HttpError, internalError } from './http-error';
export { consumePoint, tooManyRequests } from './rate-limit';
export { readBody } from './request-body';
export { parseRequestTarget } from './request-target';
export { shortageOf } from './resource-shortage';
export {
  errorResponse,
  type HttpResponse,
  jsonResponse,
  noContent,
  sendError,
  sendResponse,
  textResponse,
} from './response';
export { type Call, createRouter, jsonOf, noPage, type Route, rejectionOf, type Service, textOf } from './router';
export { secretWeakness } from './secret-strength';
export { contentSecurityPolicy, permissionsPolicy } from './security-headers';
export { createSitePolicy, type SitePolicy } from './site-policy';
export { readSoftwareVersion, type Software } from './software-version';
export { answerCalls, startThread, ThreadCalls, ThreadUnavailable } from './thread-calls';
export type { Credentials, UpgradeListener } from './web-server';
export {
  answering,
  followResponse,
  handingOver,
  handshakeTimeoutMs,
  ignoreOffer,
  lastResponse,
  prepareServer,
} from './web-server';
