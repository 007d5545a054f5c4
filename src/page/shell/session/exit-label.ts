/** Returns what the button says that ends a session; `passthrough`: the session shows the room around the user. */
export const exitLabel = (passthrough: boolean): string => (passthrough ? 'Exit AR' : 'Exit VR');
