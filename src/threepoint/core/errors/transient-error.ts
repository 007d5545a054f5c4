/**
 * A fault that may pass, so that a later attempt may succeed: a lost network, or a server that lacks the file for now.
 */
export class TransientError extends Error {}
