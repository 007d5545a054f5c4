/** An invalid setting of the server; the message is for the person at the terminal. */
export class ConfigurationError extends Error {}
