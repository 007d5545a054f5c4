// "threepoint-http": the parts of an HTTP server that rooms and studies share.
export { AdminGuard } from './admin-guard';
export type { AuthAttempt, FailedAttempt } from './auth-throttle';
export { createAuthThrottle, TooManyAttempts } from './auth-throttle';
export type { ClientAddress } from './client-address';
export { clientAddressOf, findClientAddress, requiredAddress } from './client-address';
export { ConfigurationError } from './configuration-error';
export { ConnectionLimiter, createSlotCounter } from './connection-limiter';
export { invalidVariable, numberFrom, splitList } from './environment';
export { GroupCommit } from './group-commit';
export { guarded } from './guarded';
export { HttpError } from './http-error';
export { consumePoint, tooManyRequests } from './rate-limit';
export { readBody } from './request-body';
export { parseRequestTarget } from './request-target';
export { shortageOf } from './resource-shortage';
export type { HttpResponse } from './response';
export {
  jsonResponse,
  noContent,
  sendError,
  sendResponse,
  textResponse,
} from './response';
export type { Call, Route, Service } from './router';
export { createRouter, jsonOf, noPage, refusalOf, textOf } from './router';
export { secretWeakness } from './secret-strength';
export { contentSecurityPolicy, permissionsPolicy } from './security-headers';
export type { SitePolicy } from './site-policy';
export { createSitePolicy } from './site-policy';
export type { Software } from './software-version';
export { readSoftwareVersion } from './software-version';
export { answerCalls, logFrom, startThread, ThreadCalls, ThreadUnavailable } from './thread-calls';
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
