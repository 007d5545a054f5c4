/** The connections of an HTTP server. */
export interface ConnectionCounts {
  /** Open connections, silent ones included. */
  readonly open: number;
  /** Connections refused since the start because their address had too many. */
  readonly refused: number;
}
