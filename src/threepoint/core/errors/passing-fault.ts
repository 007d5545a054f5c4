/** What may go well when it is tried again after a while: a network that was lost, a server that does not have it yet. */
export class PassingFault extends Error {}
