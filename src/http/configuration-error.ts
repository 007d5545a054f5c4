/** A setting of the server that cannot be used; the message is for the person at the terminal. */
export class ConfigurationError extends Error {}
